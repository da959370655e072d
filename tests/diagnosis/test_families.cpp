// A machine's families of numbers fitted at once: its friction as it is, and bodies that can be.
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

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

/// Mass and first moment on the third link, fitted to a machine whose link would have its centre of
/// mass far outside; by how much it is outside as fitted.
double excess_within(double edge) {
  constexpr int kJoint = 3;
  const effects::LawPointer law = effects::find_law("link_mass", "mounted");
  simulation::Machine truth = robot().machine();
  const model::ChainJoint& link = truth.robot.elastic.joints[kJoint - 1];
  const double far = 3 * link.mass;  // kg·m
  law->apply({0, 0, far, 0}, kJoint, &truth);
  const Observations observations = robot().observed(truth);
  Hypothesis mounted(law, kJoint, robot().robot);
  mounted.set_bounds({{-1, 1, 0.1}, {-2 * far, 2 * far, 1}, {-2 * far, 2 * far, 1}, {-1, 1, 0.1}});
  mounted.edge = edge;
  const Fit fitted = fit(observations, {{mounted, {0, 0, 0, 0}}}, 20);
  TEST_ASSERT_TRUE(fitted.chosen.front().values[2] > 0.05 * far);
  return law->excess(robot().robot, fitted.machine.robot, effects::size_of(robot().robot), kJoint, 0)
      .norm();
}

void a_body_with_an_edge_is_held_within_what_can_be() {
  TEST_ASSERT_TRUE(excess_within(1e-4) <= 0);
  TEST_ASSERT_TRUE(excess_within(std::numeric_limits<double>::infinity()) > 0.1);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_body_with_an_edge_is_held_within_what_can_be);
  RUN_TEST(friction_of_all_joints_is_told_and_nothing_else_beside_it);
  return UNITY_END();
}
