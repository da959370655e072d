// Drives that are coupled, told by the torques of the motors or of the joints.
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

constexpr int kMotor = 3;
constexpr double kRatio = 0.8;

/// With friction, by which a coupling shows in the torques of the joints.
DrivenRobot rubbing() {
  DrivenRobot robot;
  robot.robot.dynamics[kMotor - 1].viscous = 300;  // N·m·s/rad
  return robot;
}

simulation::Machine coupled(const DrivenRobot& robot) {
  simulation::Machine truth = robot.machine();
  truth.robot.transmission(kMotor - 1, kMotor - 2) = kRatio;
  return truth;
}

/// The same, its torques those of the motors: by d'Alembert's principle, joint by joint.
simulation::Machine shown_by_motors(const DrivenRobot& robot) {
  simulation::Machine truth = coupled(robot);
  truth.terms.push_back(
      {simulation::Term::instrument, [](const simulation::Scene&, const simulation::Simulation&,
                                        simulation::Prediction* prediction) {
         Eigen::MatrixXd& torque = prediction->channel[simulation::joint_torque];
         torque.col(kMotor - 2) -= kRatio * torque.col(kMotor - 1);
       }});
  return truth;
}

void assert_found(const DrivenRobot& robot, const simulation::Machine& truth, const char* form) {
  const std::vector<Finding> found = findings_of(robot.observed(truth));
  TEST_ASSERT_EQUAL_UINT64(1, found.size());
  TEST_ASSERT_EQUAL_STRING("transmission", found[0].chosen.hypothesis.effect().c_str());
  TEST_ASSERT_EQUAL_STRING(form, found[0].chosen.hypothesis.law->form.c_str());
  TEST_ASSERT_EQUAL(kMotor, found[0].chosen.hypothesis.joint);
  TEST_ASSERT_DOUBLE_WITHIN(0.02, kRatio, found[0].chosen.values[0]);
}

/// In whatever order the couplings are told.
void motors_have_the_power_of_the_joints() {
  const DrivenRobot robot = rubbing();
  for (const int first : {kMotor, kMotor + 1}) {
    simulation::Machine machine = robot.machine();
    const effects::LawPointer law = effects::find_law("transmission", "motor_torques");
    law->apply({-0.4}, first, &machine);
    law->apply({kRatio}, 2 * kMotor + 1 - first, &machine);
    const Eigen::MatrixXd of_motors = shown_torques(machine, robot.scene);
    machine.shows_motor_torques = false;
    const Eigen::MatrixXd of_joints = shown_torques(machine, robot.scene);
    const Eigen::MatrixXd speed = simulation::simulate(machine, robot.scene).velocity;
    const Eigen::MatrixXd motor_speed = speed * machine.robot.transmission.transpose();
    const Eigen::VectorXd by_joints = of_joints.cwiseProduct(speed).rowwise().sum();
    const Eigen::VectorXd by_motors = of_motors.cwiseProduct(motor_speed).rowwise().sum();
    TEST_ASSERT_TRUE((by_joints - by_motors).norm() < 1e-9 * by_joints.norm());
    TEST_ASSERT_TRUE((of_joints - of_motors).norm() > 1e-3 * of_joints.norm());
  }
}

void a_coupling_is_found_in_the_torques_of_the_motors() {
  const DrivenRobot robot = rubbing();
  assert_found(robot, shown_by_motors(robot), "motor_torques");
}

void a_coupling_is_found_in_the_torques_of_the_joints() {
  const DrivenRobot robot = rubbing();
  assert_found(robot, coupled(robot), "");
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(motors_have_the_power_of_the_joints);
  RUN_TEST(a_coupling_is_found_in_the_torques_of_the_motors);
  RUN_TEST(a_coupling_is_found_in_the_torques_of_the_joints);
  return UNITY_END();
}
