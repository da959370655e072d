// Torques that change with a temperature: friction that falls and gains that drift where it was
// recorded, and a gain by the heat of the drive where it was not.
#include <cmath>
#include <functional>

#include "diagnosis/diagnosed.hpp"
#include "diagnosis/driven_robot.hpp"
#include "unity_main.hpp"

using flexcomp::diagnosis::Finding;
using flexcomp::test::DrivenRobot;
using flexcomp::test::findings_of;
namespace simulation = flexcomp::simulation;

namespace {

constexpr double kCold = 20;         // °C
constexpr double kViscous = 300;     // N·m·s/rad
constexpr double kDry = 20;          // N·m, which warming leaves as it is
constexpr double kFriction = -0.03;  // 1/K
constexpr double kGain = 0.004;      // 1/K

/// An arm with friction that warms by 15 K.
DrivenRobot warming() {
  DrivenRobot robot;
  for (flexcomp::model::JointDynamics& joint : robot.robot.dynamics) {
    joint.viscous = kViscous;
    joint.coulomb = kDry;
  }
  const Eigen::VectorXd& time = robot.recording.time;
  const double end = time[time.size() - 1];
  robot.recording.temperature = kCold + 15 * (1 - (-3 * time.array() / end).exp());
  robot.robot.reference_temperature = kCold;
  return robot;
}

/// A machine whose torques are `altered` at every joint by the warming (K) and the speed (rad/s).
using Alteration = std::function<double(double torque, double warming, double speed)>;
simulation::Machine altered(const DrivenRobot& robot, simulation::Term::Stage stage, int joint,
                            const Alteration& alteration) {
  simulation::Machine truth = robot.machine();
  truth.terms.push_back(
      {stage, [=](const simulation::Scene& scene, const simulation::Simulation& at,
                  simulation::Prediction* prediction) {
         Eigen::MatrixXd& torque = prediction->channel[simulation::joint_torque];
         for (Eigen::Index column = 0; column < torque.cols(); ++column) {
           for (Eigen::Index row = 0; row < torque.rows() && (joint == 0 || joint == column + 1);
                ++row) {
             torque(row, column) = alteration(torque(row, column), scene.temperature[row] - kCold,
                                              at.velocity(row, column));
           }
         }
       }});
  return truth;
}

/// The one finding, by its numbers.
flexcomp::effects::Values assert_found(const DrivenRobot& robot, const simulation::Machine& truth,
                                       const char* effect, const char* form, int joint,
                                       double rate) {
  const std::vector<Finding> found = findings_of(robot.observed(truth));
  TEST_ASSERT_EQUAL_UINT64(1, found.size());
  TEST_ASSERT_EQUAL_STRING(effect, found[0].chosen.hypothesis.effect().c_str());
  TEST_ASSERT_EQUAL_STRING(form, found[0].chosen.hypothesis.law->form.c_str());
  TEST_ASSERT_EQUAL(joint, found[0].chosen.hypothesis.joint);
  TEST_ASSERT_DOUBLE_WITHIN(0.1 * std::abs(rate), rate, found[0].chosen.values[0]);
  return found[0].chosen.values;
}

double thinner(double torque, double warming, double speed) {
  return torque + kViscous * speed * (std::exp(kFriction * warming) - 1);
}

double weaker(double torque, double warming, double /*speed*/) {
  return torque * (1 + kGain * warming);
}

void friction_that_falls_at_one_joint_is_found() {
  const DrivenRobot robot = warming();
  assert_found(robot, altered(robot, simulation::Term::output, 2, thinner), "friction_temperature",
               "viscous", 2, kFriction);
}

void friction_that_falls_at_all_joints_is_one_finding() {
  const DrivenRobot robot = warming();
  assert_found(robot, altered(robot, simulation::Term::output, 0, thinner), "friction_temperature",
               "viscous", 0, kFriction);
}

void drives_that_warm_alike_are_one_finding() {
  const DrivenRobot robot = warming();
  assert_found(robot, altered(robot, simulation::Term::instrument, 0, weaker), "torque_gain",
               "temperature", 0, kGain);
}

/// The current that a joint's drive shows while it loses torque by what it gave before: of the
/// heat's equation in steps of a hundredth of a row.
simulation::Machine worn_out(const DrivenRobot& robot, int joint, double loss, double constant) {
  simulation::Machine truth = robot.machine();
  truth.terms.push_back({simulation::Term::instrument,
                         [=](const simulation::Scene& scene, const simulation::Simulation& /*at*/,
                             simulation::Prediction* prediction) {
                           constexpr int kSteps = 100;
                           auto torque =
                               prediction->channel[simulation::joint_torque].col(joint - 1);
                           double heat = torque[0] * torque[0];
                           for (Eigen::Index row = 0; row < torque.size(); ++row) {
                             const double step =
                                 row == 0 ? 0 : (scene.time[row] - scene.time[row - 1]) / kSteps;
                             for (int i = 0; i < kSteps; ++i) {
                               heat += (torque[row] * torque[row] - heat) * step / constant;
                             }
                             torque[row] *= 1 + loss * heat;
                           }
                         }});
  return truth;
}

void a_drive_that_loses_torque_by_its_own_heat_is_found() {
  constexpr double kLoss = 2e-8;   // 1/(N·m)²
  constexpr double kConstant = 4;  // s
  const DrivenRobot robot;
  const simulation::Machine truth = worn_out(robot, 2, kLoss, kConstant);
  const flexcomp::effects::Values told =
      assert_found(robot, truth, "torque_gain", "heat", 2, kLoss);
  TEST_ASSERT_DOUBLE_WITHIN(0.2 * kConstant, kConstant, told[1]);
}

void an_arm_that_only_warms_is_left_alone() {
  const DrivenRobot robot = warming();
  TEST_ASSERT_TRUE(findings_of(robot.observed(robot.machine())).empty());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(friction_that_falls_at_one_joint_is_found);
  RUN_TEST(friction_that_falls_at_all_joints_is_one_finding);
  RUN_TEST(drives_that_warm_alike_are_one_finding);
  RUN_TEST(a_drive_that_loses_torque_by_its_own_heat_is_found);
  RUN_TEST(an_arm_that_only_warms_is_left_alone);
  return UNITY_END();
}
