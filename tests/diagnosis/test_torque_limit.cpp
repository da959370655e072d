// A torque that is shown up to a limit: as clipped, as found, and not where none was reached.
#include <algorithm>

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

constexpr int kJoint = 3;

double largest(const DrivenRobot& robot) {
  return shown_torques(robot.machine(), robot.scene).col(kJoint - 1).cwiseAbs().maxCoeff();
}

/// A machine whose sensor goes to a share of the largest torque of the model's joint.
simulation::Machine clipped(const DrivenRobot& robot, double share, simulation::Machine truth) {
  const double limit = share * largest(robot);
  truth.terms.push_back(
      {simulation::Term::instrument, [=](const simulation::Scene&, const simulation::Simulation&,
                                         simulation::Prediction* prediction) {
         for (double& torque : prediction->channel[simulation::joint_torque].col(kJoint - 1)) {
           torque = std::clamp(torque, -limit, limit);
         }
       }});
  return truth;
}

simulation::Machine clipped(const DrivenRobot& robot, double share) {
  return clipped(robot, share, robot.machine());
}

void a_torque_is_shown_up_to_the_limit_and_others_as_they_are() {
  const DrivenRobot robot;
  simulation::Machine machine = robot.machine();
  effects::find_law("torque_limit", "")->apply({0.5 * largest(robot)}, kJoint, &machine);
  const Eigen::MatrixXd shown = shown_torques(machine, robot.scene);
  const Eigen::MatrixXd expected = shown_torques(clipped(robot, 0.5), robot.scene);
  TEST_ASSERT_TRUE((shown - expected).cwiseAbs().maxCoeff() < 1e-9);
}

void a_limit_that_was_reached_is_found() {
  const DrivenRobot robot;
  const std::vector<Finding> found = findings_of(robot.observed(clipped(robot, 0.8)));
  TEST_ASSERT_EQUAL_UINT64(1, found.size());
  TEST_ASSERT_EQUAL_STRING("torque_limit", found[0].chosen.hypothesis.effect().c_str());
  TEST_ASSERT_EQUAL(kJoint, found[0].chosen.hypothesis.joint);
  const double limit = 0.8 * largest(robot);
  TEST_ASSERT_DOUBLE_WITHIN(0.01 * limit, limit, found[0].chosen.values[0]);
}

void a_limit_that_was_not_reached_is_not_found() {
  const DrivenRobot robot;
  TEST_ASSERT_TRUE(findings_of(robot.observed(clipped(robot, 1.2))).empty());
}

/// The model as it was does not get there.
void a_limit_that_a_load_reaches_is_found_beside_it() {
  const DrivenRobot robot;
  simulation::Machine truth = robot.machine();
  const effects::LawPointer load = effects::find_law("payload", "");
  effects::Values values(load->parameters(robot.robot, 0).size(), 0.0);
  values[0] = 150;  // kg
  load->apply(values, 0, &truth);
  const std::vector<Finding> found = findings_of(robot.observed(clipped(robot, 1.05, truth)));
  TEST_ASSERT_EQUAL_UINT64(2, found.size());
  TEST_ASSERT_EQUAL_STRING("torque_limit", found[1].chosen.hypothesis.effect().c_str());
  const double limit = 1.05 * largest(robot);
  TEST_ASSERT_DOUBLE_WITHIN(0.01 * limit, limit, found[1].chosen.values[0]);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_torque_is_shown_up_to_the_limit_and_others_as_they_are);
  RUN_TEST(a_limit_that_was_reached_is_found);
  RUN_TEST(a_limit_that_was_not_reached_is_not_found);
  RUN_TEST(a_limit_that_a_load_reaches_is_found_beside_it);
  return UNITY_END();
}
