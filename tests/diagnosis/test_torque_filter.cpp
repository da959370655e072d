// Torques behind a low-pass: as filtered, as found, and told from torques that are late.
#include <cmath>

#include "diagnosis/diagnosed.hpp"
#include "diagnosis/driven_robot.hpp"
#include "unity_main.hpp"

using flexcomp::diagnosis::Finding;
using flexcomp::test::DrivenRobot;
using flexcomp::test::findings_of;
using flexcomp::test::shown_torques;
namespace effects = flexcomp::effects;
namespace simulation = flexcomp::simulation;

namespace {

constexpr double kConstant = 0.03;  // s

/// T y' + y = x by Euler's implicit rule in twenty steps a row, x straight between the rows.
Eigen::VectorXd filtered(const Eigen::VectorXd& time, const Eigen::VectorXd& input) {
  constexpr int steps = 20;
  Eigen::VectorXd output = input;
  for (Eigen::Index row = 1; row < input.size(); ++row) {
    const double step = (time[row] - time[row - 1]) / steps;
    double shown = output[row - 1];
    for (int i = 1; i <= steps; ++i) {
      const double now = input[row - 1] + (input[row] - input[row - 1]) * i / steps;
      shown = (shown + step / kConstant * now) / (1 + step / kConstant);
    }
    output[row] = shown;
  }
  return output;
}

/// A machine whose torques are filtered so, or one joint's.
simulation::Machine behind_a_filter(const DrivenRobot& robot, int joint = 0) {
  simulation::Machine truth = robot.machine();
  truth.terms.push_back({simulation::Term::instrument,
                         [=](const simulation::Scene& scene, const simulation::Simulation&,
                             simulation::Prediction* prediction) {
                           Eigen::MatrixXd& torque = prediction->channel[simulation::joint_torque];
                           for (Eigen::Index column = 0; column < torque.cols(); ++column) {
                             if (joint == 0 || joint == column + 1) {
                               torque.col(column) = filtered(scene.time, torque.col(column));
                             }
                           }
                         }});
  return truth;
}

void assert_found(const std::vector<Finding>& found, int joint) {
  TEST_ASSERT_EQUAL_UINT64(1, found.size());
  TEST_ASSERT_EQUAL_STRING("torque_filter", found[0].chosen.hypothesis.effect().c_str());
  TEST_ASSERT_EQUAL(joint, found[0].chosen.hypothesis.joint);
  TEST_ASSERT_DOUBLE_WITHIN(0.05 * kConstant, kConstant, found[0].chosen.values[0]);
}

void torques_are_shown_as_the_filter_lets_them_through() {
  const DrivenRobot robot;
  simulation::Machine machine = robot.machine();
  const Eigen::MatrixXd plain = shown_torques(machine, robot.scene);
  effects::find_law("torque_filter", "")->apply({kConstant}, 0, &machine);
  const Eigen::MatrixXd shown = shown_torques(machine, robot.scene);
  const Eigen::MatrixXd expected = shown_torques(behind_a_filter(robot), robot.scene);
  const Eigen::Index settled = plain.rows() / 4;  // each begins in its own way
  const auto last = [&](const Eigen::MatrixXd& all) {
    return Eigen::MatrixXd(all.bottomRows(plain.rows() - settled));
  };
  TEST_ASSERT_TRUE((last(shown) - last(expected)).norm() <
                   0.05 * (last(plain) - last(expected)).norm());
}

void a_filter_of_all_torques_is_found() {
  const DrivenRobot robot;
  assert_found(findings_of(robot.observed(behind_a_filter(robot))), 0);
}

void a_filter_of_one_torque_is_found() {
  const DrivenRobot robot;
  assert_found(findings_of(robot.observed(behind_a_filter(robot, 2))), 2);
}

void torques_that_are_late_are_not_filtered() {
  const DrivenRobot robot;
  simulation::Machine late = robot.machine();
  effects::find_law("time_offset", "joint_torque")->apply({kConstant}, 0, &late);
  const std::vector<Finding> found = findings_of(robot.observed(late));
  TEST_ASSERT_EQUAL_UINT64(1, found.size());
  TEST_ASSERT_EQUAL_STRING("time_offset", found[0].chosen.hypothesis.effect().c_str());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(torques_are_shown_as_the_filter_lets_them_through);
  RUN_TEST(a_filter_of_all_torques_is_found);
  RUN_TEST(a_filter_of_one_torque_is_found);
  RUN_TEST(torques_that_are_late_are_not_filtered);
  return UNITY_END();
}
