// A hose along the arm, against virtual work by its length's differences and the same torques.
#include "effects/learned.hpp"
#include "effects/moving_robot.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

constexpr int kJoint = 4;  // held on link 3
constexpr double kStiffness = 900;
constexpr double kFriction = 40;
constexpr double kSlack = 0.6;
const Vector3<double> kArm(0.2, 0.3, -0.1);
const Vector3<double> kTool(0.1, -0.05, 0.15);

/// Length from end to end in a posture of the stiff robot, m.
double length_at(const model::Robot& robot, const model::JointValues& q) {
  const model::ChainKinematics at = model::forward_kinematics(robot.elastic, q);
  const Pose<double>& link = at.links[kJoint - 2];
  return (at.tcp.position + at.tcp.rotation * kTool - link.position - link.rotation * kArm).norm();
}

simulation::Prediction shown(const model::Robot& robot, const simulation::Scene& scene,
                             double stiffness, double friction, double slack) {
  simulation::Machine machine = effects::machine_of(robot);
  effects::find_law("dress_pack", "")
      ->apply({stiffness, friction, slack, kArm.x(), kArm.y(), kArm.z(), kTool.x(), kTool.y(),
               kTool.z()},
              kJoint, &machine);
  return predict(machine, {scene}).front();
}

/// What each drive bears more by the hose (rows × joints, N·m).
Eigen::MatrixXd torque_of(double stiffness, double friction, double slack) {
  const test::MovingRobot free;
  return shown(free.robot, free.scene(), stiffness, friction, slack).channel[1] -
         predict(effects::machine_of(free.robot), {free.scene()}).front().channel[1];
}

void its_torques_are_the_work_that_stretching_it_takes() {
  const test::MovingRobot free;
  const Eigen::MatrixXd found = torque_of(kStiffness, 0, kSlack);
  constexpr double kStep = 1e-5;  // rad
  for (Eigen::Index row = 0; row < found.rows(); row += 20) {
    const model::JointValues q = free.recording.q_meas->row(row).transpose();
    const double tension = kStiffness * std::max(length_at(free.robot, q) - kSlack, 0.0);
    for (Eigen::Index joint = 0; joint < 6; ++joint) {
      const model::JointValues step = kStep * model::JointValues::Unit(6, joint);
      const double slope =
          (length_at(free.robot, q + step) - length_at(free.robot, q - step)) / (2 * kStep);
      TEST_ASSERT_DOUBLE_WITHIN(0.01 * tension, tension * slope, found(row, joint));
    }
  }
  TEST_ASSERT_TRUE(found.rightCols(3).cwiseAbs().maxCoeff() > 10);
}

void joints_before_the_link_that_holds_it_bear_nothing() {
  const Eigen::MatrixXd found = torque_of(kStiffness, kFriction, kSlack);
  TEST_ASSERT_EQUAL_DOUBLE(0, found.leftCols(kJoint - 1).cwiseAbs().maxCoeff());
}

void a_slack_one_pulls_nothing() {
  TEST_ASSERT_EQUAL_DOUBLE(0, torque_of(kStiffness, 0, 5).cwiseAbs().maxCoeff());
}

void what_rubs_takes_power_from_the_drives() {
  const test::MovingRobot free;
  const Eigen::MatrixXd found = torque_of(0, kFriction, kSlack);
  const Eigen::MatrixXd speed = free.scene().velocity;
  const Eigen::VectorXd power = found.cwiseProduct(speed).rowwise().sum();
  TEST_ASSERT_TRUE(power.minCoeff() > -1e-9);
  for (Eigen::Index row = 0; row < found.rows(); row += 20) {
    const model::JointValues q = free.recording.q_meas->row(row).transpose();
    constexpr double kTime = 1e-4;  // s
    const model::JointValues step = kTime * speed.row(row).transpose();
    const double lengthening =
        (length_at(free.robot, q + step) - length_at(free.robot, q - step)) / (2 * kTime);
    const double expected = kFriction * std::abs(lengthening);
    TEST_ASSERT_DOUBLE_WITHIN(0.02 * expected + 0.05, expected, power[row]);
  }
}

void it_shows_at_the_tcp_and_the_link_encoders() {
  const test::MovingRobot free;
  const simulation::Prediction before =
      predict(effects::machine_of(free.robot), {free.scene()}).front();
  const simulation::Prediction with =
      shown(free.robot, free.scene(), kStiffness, kFriction, kSlack);
  const Eigen::MatrixXd torque = with.channel[1] - before.channel[1];
  for (Eigen::Index joint = kJoint - 1; joint < 6; ++joint) {
    const double compliance = free.robot.elastic.joint(joint).compliance;
    const Eigen::VectorXd windup = with.channel[2].col(joint) - before.channel[2].col(joint);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, (windup + compliance * torque.col(joint)).norm());
  }
  TEST_ASSERT_TRUE((with.channel[0] - before.channel[0]).norm() > 0);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(its_torques_are_the_work_that_stretching_it_takes);
  RUN_TEST(joints_before_the_link_that_holds_it_bear_nothing);
  RUN_TEST(a_slack_one_pulls_nothing);
  RUN_TEST(what_rubs_takes_power_from_the_drives);
  RUN_TEST(it_shows_at_the_tcp_and_the_link_encoders);
  return UNITY_END();
}
