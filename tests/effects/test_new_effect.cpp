// A new effect is its law, its search (both in tests/effects/extra) and a line in the catalogue: it
// is found, named and learnt then, nothing else having been touched.
#include "diagnosis/diagnosed.hpp"
#include "diagnosis/output/json.hpp"
#include "diagnosis/swinging_robot.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

constexpr double kSlope = 4e-4;  // m/rad

void a_new_effect_is_found_named_and_learnt() {
  const test::SwingingRobot swinging(1);
  Eigen::MatrixXd error = Eigen::MatrixXd::Zero(swinging.rows(), 3);
  error.col(2) = kSlope * swinging.scene.q.col(0);
  diagnosis::Observations observations = swinging.observed(error);
  const std::vector<diagnosis::Hypothesis> hypotheses = diagnosis::all_hypotheses(observations);
  const diagnosis::Diagnosis found =
      diagnosis::diagnose(&observations, hypotheses, test::quiet_settings());
  TEST_ASSERT_EQUAL_UINT64(1, found.choice.findings.size());
  const nlohmann::ordered_json first = to_json(observations, found).at("findings").at(0);
  TEST_ASSERT_EQUAL_STRING("sloping_floor", first.at("effect").get<std::string>().c_str());
  const double slope = first.at("parameters").at("slope").at("value");
  TEST_ASSERT_DOUBLE_WITHIN(0.02 * kSlope, kSlope, slope);
  const model::Robot updated =
      effects::with_learned(swinging.robot, found.updated().placed(observations));
  TEST_ASSERT_EQUAL_STRING("sloping_floor", updated.effects.at(0).effect.c_str());
  const simulation::Machine machine = effects::machine_of(updated, {swinging.scene});
  const Eigen::MatrixXd shown =
      simulation::predict(machine, {swinging.scene}).front().channel[simulation::tcp_position];
  TEST_ASSERT_DOUBLE_WITHIN(0.02 * error.cwiseAbs().maxCoeff(), 0,
                            (shown - swinging.predicted - error).cwiseAbs().maxCoeff());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_new_effect_is_found_named_and_learnt);
  return UNITY_END();
}
