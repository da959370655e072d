#include "rsi/axes.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kClose = 1e-12;

void degrees_are_radians_where_the_urdf_follows_kukas_convention() {
  const JointAngles joints = AxisConvention().to_joints({180, -90, 90, 45, -30, 0});
  const JointAngles expected = {kPi, -kPi / 2, kPi / 2, kPi / 4, -kPi / 6, 0};
  for (std::size_t i = 0; i < 6; ++i) {
    TEST_ASSERT_DOUBLE_WITHIN(kClose, expected[i], joints[i]);
  }
}

/// A URDF whose zero is the upright arm, and whose first joint turns about +z.
void signs_and_zeros_lead_to_another_convention() {
  AxisConvention axes;
  axes.sign = {-1, 1, 1, 1, 1, 1};
  axes.zero = {0, -90, 90, 0, 0, 0};
  const JointAngles upright = axes.to_joints({10, -90, 90, 0, 0, 0});
  TEST_ASSERT_DOUBLE_WITHIN(kClose, -10 * kPi / 180, upright[0]);
  TEST_ASSERT_DOUBLE_WITHIN(kClose, 0, upright[1]);
  TEST_ASSERT_DOUBLE_WITHIN(kClose, 0, upright[2]);
}

void there_and_back_is_the_same() {
  AxisConvention axes;
  axes.sign = {-1, 1, -1, 1, -1, 1};
  axes.zero = {1, -90, 90, 4, 5, 6};
  const AxisAngles angles = {-170, -146, 155, 350, -125, -350};
  const AxisAngles again = axes.to_axes(axes.to_joints(angles));
  const JointAngles difference = {1e-3, -2e-3, 3e-3, 0, 1, -1};
  const JointAngles same = axes.to_difference(axes.to_correction(difference));
  for (std::size_t i = 0; i < 6; ++i) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-10, angles[i], again[i]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, difference[i], same[i]);
  }
}

void a_correction_moves_the_joint_by_what_was_corrected() {
  AxisConvention axes;
  axes.sign = {-1, 1, -1, 1, -1, 1};
  axes.zero = {1, -90, 90, 4, 5, 6};
  const AxisAngles setpoint = {10, 20, 30, 40, 50, 60};
  const JointAngles wanted = {1e-3, -2e-3, 3e-3, -4e-3, 5e-3, -6e-3};
  const AxisAngles correction = axes.to_correction(wanted);
  AxisAngles corrected = setpoint;
  for (std::size_t i = 0; i < 6; ++i) {
    corrected[i] += correction[i];
  }
  const JointAngles before = axes.to_joints(setpoint);
  const JointAngles after = axes.to_joints(corrected);
  for (std::size_t i = 0; i < 6; ++i) {
    TEST_ASSERT_DOUBLE_WITHIN(kClose, wanted[i], after[i] - before[i]);
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(degrees_are_radians_where_the_urdf_follows_kukas_convention);
  RUN_TEST(signs_and_zeros_lead_to_another_convention);
  RUN_TEST(there_and_back_is_the_same);
  RUN_TEST(a_correction_moves_the_joint_by_what_was_corrected);
  return UNITY_END();
}
