// A redundant arm: what the core says of a robot does not depend on six joints; its tables do.
#include <Eigen/LU>
#include <random>

#include "flexcomp/compliance.hpp"
#include "flexcomp/guard.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

constexpr int kJoints = 7;
using Angles = JointVector<double, kJoints>;
using Arm = RobotModel<double, kJoints>;

/// Roll and pitch in turn, with links of 0.4 m, and springs of base and tool.
Arm redundant_arm() {
  Arm arm;
  for (std::size_t i = 0; i < kJoints; ++i) {
    arm.joints[i].origin.position = {0, 0, 0.4};
    arm.joints[i].axis = i % 2 == 0 ? Vector3<double>(0, 0, 1) : Vector3<double>(0, 1, 0);
    arm.joints[i].lower = -3;
    arm.joints[i].upper = 3;
    arm.joints[i].compliance = (1 + static_cast<double>(i)) * 1e-6;
    arm.joints[i].mass = 10;
    arm.joints[i].center_of_mass = {0.01, 0, 0.1};
  }
  arm.gravity = {0, 0, -9.81};
  arm.tool.position = {0.05, 0, 0.1};
  arm.base_compliance << 1e-8, 2e-8, 1e-8, 3e-8, 4e-8, 1e-8;
  arm.tool_compliance << 5e-8, 6e-8, 2e-8, 1e-7, 2e-7, 3e-7;
  return arm;
}

Angles bent() {
  Angles q;
  q << 0.3, 0.7, -0.9, -1.4, 0.8, 1.3, -0.2;
  return q;
}

Wrench<double> load() {
  Wrench<double> wrench;
  wrench << 200, -300, 250, 10, -20, 15;
  return wrench;
}

Pose<double> tcp(const Arm& arm, const Angles& q) { return forward_kinematics(arm, q).tcp; }

void the_jacobian_is_the_derivative_of_the_pose() {
  constexpr double kStep = 1e-6;
  const Arm arm = redundant_arm();
  const auto jacobian = geometric_jacobian<double, kJoints>(forward_kinematics(arm, bent()));
  for (int i = 0; i < kJoints; ++i) {
    const Angles step = kStep * Angles::Unit(i);
    const Twist<double> change =
        pose_difference(tcp(arm, bent() - step), tcp(arm, bent() + step)) / (2 * kStep);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0, (change - jacobian.col(i)).norm());
  }
}

void the_compliance_is_the_sum_of_all_springs() {
  const Arm arm = redundant_arm();
  const auto kinematics = forward_kinematics(arm, bent());
  const auto jacobian = geometric_jacobian<double, kJoints>(kinematics);
  Compliance<double> sum = structure_compliance(arm, kinematics);
  for (int i = 0; i < kJoints; ++i) {
    sum += (1 + i) * 1e-6 * jacobian.col(i) * jacobian.col(i).transpose();
  }
  TEST_ASSERT_DOUBLE_WITHIN(1e-18, 0, (sum - tcp_compliance(arm, kinematics)).norm());
}

void of_all_joint_motions_for_a_twist_the_smallest_is_taken() {
  const Arm arm = redundant_arm();
  const auto jacobian = geometric_jacobian<double, kJoints>(forward_kinematics(arm, bent()));
  Twist<double> twist;
  twist << 1, 2, 3, 0.4, 0.5, 0.6;
  const Angles motion = joint_motion<double, kJoints>(jacobian, twist);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, (jacobian * motion - twist).norm());
  const Eigen::MatrixXd kernel = Eigen::FullPivLU<Eigen::MatrixXd>(jacobian).kernel();
  TEST_ASSERT_EQUAL(1, kernel.cols());
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, kernel.col(0).normalized().dot(motion));
}

void the_corrected_arm_stands_under_load_where_it_would_without() {
  const Arm arm = redundant_arm();
  const Angles motor = bent() + setpoint_correction(arm, bent(), load());
  Angles link = motor;
  for (int i = 0; i < 50; ++i) {
    const auto kinematics = forward_kinematics(arm, link);
    const Angles torque =
        wrench_torque<double, kJoints>(geometric_jacobian<double, kJoints>(kinematics), load()) +
        weight_torque(arm, kinematics);
    link = motor + joint_windup(arm, torque);
  }
  const auto kinematics = forward_kinematics(arm, link);
  const Twist<double> structure =
      structure_compliance(arm, kinematics) * load() + structure_weight_deflection(arm, kinematics);
  const Twist<double> off = pose_difference(tcp(arm, bent()), displaced(kinematics.tcp, structure));
  const double uncorrected = deflection(arm, bent(), load()).tcp.norm();
  TEST_ASSERT_TRUE(uncorrected > 5e-4);
  TEST_ASSERT_DOUBLE_WITHIN(0.01 * uncorrected, 0, off.norm());
}

void seven_guards_side_by_side_are_seven_guards() {
  const CorrectionLimits<float> limits = {0.01F, 0.1F, 5.0F};
  std::array<CorrectionLimits<float>, kJoints> all{};
  all.fill(limits);
  JointGuards<float, kJoints> together;
  TEST_ASSERT_EQUAL(Result::ok, together.configure(all, 1e-3F));
  std::array<Guard<float>, kJoints> apart;
  for (Guard<float>& guard : apart) {
    TEST_ASSERT_EQUAL(Result::ok, guard.configure(limits, 1e-3F));
  }
  std::mt19937 random(1);
  std::uniform_real_distribution<float> target(-0.02F, 0.02F);
  for (int tick = 0; tick < 1000; ++tick) {
    JointVector<float, kJoints> targets;
    for (Eigen::Index i = 0; i < kJoints; ++i) {
      targets[i] = target(random);
    }
    const JointVector<float, kJoints> values = together.advance(targets);
    for (std::size_t i = 0; i < kJoints; ++i) {
      const auto joint = static_cast<Eigen::Index>(i);
      TEST_ASSERT_TRUE(apart[i].advance(targets[joint]) == values[joint]);
    }
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(the_jacobian_is_the_derivative_of_the_pose);
  RUN_TEST(the_compliance_is_the_sum_of_all_springs);
  RUN_TEST(of_all_joint_motions_for_a_twist_the_smallest_is_taken);
  RUN_TEST(the_corrected_arm_stands_under_load_where_it_would_without);
  RUN_TEST(seven_guards_side_by_side_are_seven_guards);
  return UNITY_END();
}
