#include <random>

#include "core/test_robots.hpp"
#include "flexcomp/chain.hpp"
#include "unity_main.hpp"

using flexcomp::axis_rotation;
using flexcomp::displaced;
using flexcomp::forward_kinematics;
using flexcomp::geometric_jacobian;
using flexcomp::JointVector;
using flexcomp::Matrix3;
using flexcomp::Pose;
using flexcomp::pose_difference;
using flexcomp::Twist;
using flexcomp::Vector3;
using flexcomp::test::kr270;
using flexcomp::test::kr270_with_everything;

namespace {

constexpr double kHalfTurn = 3.14159265358979323846;
using Angles = JointVector<double, 6>;

Angles random_angles(std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(-3, 3);
  Angles q;
  for (Eigen::Index i = 0; i < 6; ++i) {
    q[i] = uniform(*random);
  }
  return q;
}

/// All zeros: arm and forearm stretched out along x, the wrist below the shoulder by the offset.
void at_zero_the_arm_is_stretched_out() {
  const Vector3<double> tcp =
      forward_kinematics<double, 6>(kr270<double>(), Angles::Zero()).tcp.position;
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.35 + 1.25 + 1.1 + 0.23, tcp.x());
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0, tcp.y());
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.675 - 0.055, tcp.z());
}

/// A2 = −90°: arm and forearm upright; the offset now points forward.
void with_the_second_joint_at_minus_90_degrees_the_arm_is_upright() {
  Angles q = Angles::Zero();
  q[1] = -kHalfTurn / 2;
  const Vector3<double> tcp = forward_kinematics<double, 6>(kr270<double>(), q).tcp.position;
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.35 + 0.055, tcp.x());
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.675 + 1.25 + 1.1 + 0.23, tcp.z());
}

/// A1 turns about −z: a quarter turn takes x to −y.
void the_first_joint_turns_about_its_own_axis() {
  Angles q = Angles::Zero();
  q[0] = kHalfTurn / 2;
  const Vector3<double> tcp = forward_kinematics<double, 6>(kr270<double>(), q).tcp.position;
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0, tcp.x());
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, -2.93, tcp.y());
}

void the_jacobian_is_the_derivative_of_the_pose() {
  const auto model = kr270_with_everything<double>();
  std::mt19937 random(1);
  constexpr double kStep = 1e-6;
  for (int pose = 0; pose < 50; ++pose) {
    const Angles q = random_angles(&random);
    const auto jacobian = geometric_jacobian<double, 6>(forward_kinematics(model, q));
    for (Eigen::Index joint = 0; joint < 6; ++joint) {
      const Angles step = kStep * Angles::Unit(joint);
      const Pose<double> low = forward_kinematics<double, 6>(model, q - step).tcp;
      const Pose<double> high = forward_kinematics<double, 6>(model, q + step).tcp;
      const Twist<double> slope = pose_difference(low, high) / (2 * kStep);
      TEST_ASSERT_TRUE((slope - jacobian.col(joint)).cwiseAbs().maxCoeff() < 1e-8);
    }
  }
}

void float_and_double_agree() {
  const auto model = kr270_with_everything<double>();
  const auto single = model.cast<float>();
  std::mt19937 random(2);
  for (int pose = 0; pose < 200; ++pose) {
    const Angles q = random_angles(&random);
    const auto exact = forward_kinematics(model, q);
    const auto rounded = forward_kinematics<float, 6>(single, q.cast<float>());
    const double reach = exact.tcp.position.norm() + 1;
    TEST_ASSERT_TRUE((rounded.tcp.position.cast<double>() - exact.tcp.position).norm() <
                     1e-5 * reach);
    const Eigen::Matrix<double, 6, 6> difference =
        geometric_jacobian<float, 6>(rounded).cast<double>() - geometric_jacobian<double, 6>(exact);
    TEST_ASSERT_TRUE(difference.cwiseAbs().maxCoeff() < 1e-5 * reach);
  }
}

void a_displacement_is_what_pose_difference_measures() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.5, 1.5);
  const Pose<double> start =
      forward_kinematics<double, 6>(kr270<double>(), random_angles(&random)).tcp;
  for (int i = 0; i < 100; ++i) {
    Twist<double> twist;
    for (Eigen::Index row = 0; row < 6; ++row) {
      twist[row] = uniform(random);
    }
    const Twist<double> measured = pose_difference(start, displaced(start, twist));
    TEST_ASSERT_TRUE((measured - twist).cwiseAbs().maxCoeff() < 1e-12);
  }
}

void a_displacement_without_rotation_only_shifts() {
  Twist<double> shift = Twist<double>::Zero();
  shift[1] = 0.25;
  const Pose<double> shifted = displaced(Pose<double>{}, shift);
  TEST_ASSERT_TRUE(shifted.rotation.isIdentity(0));
  TEST_ASSERT_TRUE(shifted.position == Vector3<double>(0, 0.25, 0));
}

void tiny_displacements_keep_their_digits() {
  const Pose<double> start;
  Twist<double> twist;
  twist << 1e-9, 0, 0, 2e-9, -3e-9, 1e-9;
  const Twist<double> measured = pose_difference(start, displaced(start, twist));
  TEST_ASSERT_TRUE((measured - twist).cwiseAbs().maxCoeff() < 1e-16);
  TEST_ASSERT_TRUE(pose_difference(start, start).isZero(0));
}

void a_rotation_keeps_lengths_and_its_axis() {
  const Vector3<double> axis = Vector3<double>(1, -2, 0.5).normalized();
  const Matrix3<double> turn = axis_rotation<double>(axis, 0.8);
  TEST_ASSERT_TRUE((turn * axis - axis).norm() < 1e-15);
  TEST_ASSERT_TRUE((turn.transpose() * turn - Matrix3<double>::Identity()).norm() < 1e-15);
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 1 + 2 * std::cos(0.8), turn.trace());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(at_zero_the_arm_is_stretched_out);
  RUN_TEST(with_the_second_joint_at_minus_90_degrees_the_arm_is_upright);
  RUN_TEST(the_first_joint_turns_about_its_own_axis);
  RUN_TEST(the_jacobian_is_the_derivative_of_the_pose);
  RUN_TEST(float_and_double_agree);
  RUN_TEST(a_displacement_is_what_pose_difference_measures);
  RUN_TEST(a_displacement_without_rotation_only_shifts);
  RUN_TEST(tiny_displacements_keep_their_digits);
  RUN_TEST(a_rotation_keeps_lengths_and_its_axis);
  return UNITY_END();
}
