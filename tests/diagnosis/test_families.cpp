// A machine's families of numbers fitted at once: its friction as it is, and bodies that can be.
#include <Eigen/Eigenvalues>
#include <cmath>

#include "diagnosis/driven_robot.hpp"
#include "diagnosis/families/families.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using diagnosis::Chosen;
using diagnosis::Dictionary;
using diagnosis::Fit;
using diagnosis::Hypothesis;
using diagnosis::Observations;
using test::DrivenRobot;

namespace {

constexpr Eigen::Index kMoving = 5;  // joints; the sixth stands

double dry(std::size_t joint) { return 40 + 10 * static_cast<double>(joint); }       // N·m
double viscous(std::size_t joint) { return 120 - 10 * static_cast<double>(joint); }  // N·m·s/rad

const DrivenRobot& robot() {
  static const DrivenRobot driven;
  return driven;
}

Fit fitted(const Observations& observations) {
  const std::vector<Hypothesis> hypotheses = all_hypotheses(observations);
  const Dictionary dictionary(observations, hypotheses, [](std::size_t, std::size_t) {});
  return fit_families(observations, fit(observations, {}, 0), hypotheses, dictionary);
}

void friction_of_all_joints_is_told_and_nothing_else_beside_it() {
  simulation::Machine truth = robot().machine();
  for (std::size_t i = 0; i < kMoving; ++i) {
    truth.robot.dynamics[i].coulomb += dry(i);
    truth.robot.dynamics[i].viscous += viscous(i);
  }
  const Observations observations = robot().observed(truth);
  const Fit fit = fitted(observations);
  for (std::size_t i = 0; i < kMoving; ++i) {
    const model::JointDynamics& model = robot().robot.dynamics[i];
    const model::JointDynamics& found = fit.machine.robot.dynamics[i];
    TEST_ASSERT_DOUBLE_WITHIN(0.04 * dry(i), dry(i), found.coulomb - model.coulomb);
    TEST_ASSERT_DOUBLE_WITHIN(0.06 * viscous(i), viscous(i), found.viscous - model.viscous);
  }
  // Whatever else stays, since it predicts no worse, is not told from nothing.
  constexpr double kTold = 4;  // standard deviations
  for (std::size_t i = 0; i < fit.chosen.size(); ++i) {
    const std::string effect = fit.chosen[i].hypothesis.effect();
    if (effect == "coulomb_friction" || effect == "viscous_friction") {
      continue;
    }
    const Eigen::MatrixXd covariance = fit.covariance_of(i);
    for (std::size_t k = 0; k < fit.chosen[i].values.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(kTold * std::sqrt(covariance(at, at)) + 1e-12, 0,
                                        fit.chosen[i].values[k], effect.c_str());
    }
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(friction_of_all_joints_is_told_and_nothing_else_beside_it);
  return UNITY_END();
}
