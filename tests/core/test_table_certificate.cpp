/// The bound of a path table's certificate, where a deflection of one joint attains it: a bound
/// that left out a term would be too small there.
#include "table_certificate.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

constexpr Eigen::Index kJoint = 2;
constexpr double kCompliance = 3e-7;  // rad/(N·m)
constexpr double kForce = 900;        // N
constexpr double kLever = 1.7;        // m
constexpr double kTorque = 800;       // N·m
constexpr double kMotion = 2e-4;      // rad

struct Segment {
  ModelBounds<double, 6> bounds = {};
  TableEntry<double, 6> from = {};
  TableEntry<double, 6> to = {};

  Segment() {
    for (auto* vector : {&bounds.lever, &bounds.torque, &bounds.compliance, &bounds.cubic}) {
      vector->setZero();
    }
    for (TableEntry<double, 6>* entry : {&from, &to}) {
      entry->jacobian.setZero();
      entry->weight_torque.setZero();
      entry->structure.setZero();
      entry->structure_motion.setZero();
      entry->structure_weight.setZero();
      entry->structure_weight_motion.setZero();
    }
    bounds.lever[kJoint] = kLever;
    bounds.torque[kJoint] = kTorque;
    bounds.compliance[kJoint] = kCompliance;
  }

  double curvature(const SegmentMotion<double>& motion) const {
    return segment_curvature<double, 6>(bounds, from, to, {kForce, 0}, motion).position;
  }
};

/// The lever goes from a to b, and the force's torque with it: k F (a + (b - a) t)², t'' included.
void a_blend_of_levers_bends_as_their_square_does() {
  constexpr double kFrom = 1.2, kSpeed = 1.5, kAcceleration = 0.7;
  Segment segment;
  segment.from.jacobian(0, kJoint) = kFrom;
  segment.to.jacobian(0, kJoint) = kLever;
  segment.bounds.torque[kJoint] = kLever * kForce;
  const double change = kLever - kFrom;
  const double at_the_end = 2 * kCompliance * kForce *
                            (change * change * kSpeed * kSpeed + kLever * change * kAcceleration);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12 * at_the_end, at_the_end,
                            segment.curvature({0, kSpeed, kAcceleration}));
}

/// The model's lever R sin(v s) times a torque that goes from -T to T: at s = 0 both change, and
/// the second derivative is twice the product of their speeds. Joints hardly move, so that v² is
/// nothing.
void a_blended_torque_at_a_lever_that_turns_bends_by_both_speeds() {
  constexpr double kJointSpeed = 0.001, kSpeed = 2;
  Segment segment;
  segment.from.weight_torque[kJoint] = -kTorque;
  segment.to.weight_torque[kJoint] = kTorque;
  const double attained = 2 * kCompliance * kLever * kJointSpeed * 2 * kTorque * kSpeed;
  const double bound = segment.curvature({kJointSpeed, kSpeed, 0});
  TEST_ASSERT_TRUE(bound >= attained);
  TEST_ASSERT_TRUE(bound < 1.01 * attained);
}

/// The same of the motion that makes up for the springs of base, links and tool.
void a_blended_motion_at_a_lever_that_turns_bends_by_both_speeds() {
  constexpr double kJointSpeed = 0.001, kSpeed = 2;
  Segment segment;
  segment.bounds.compliance[kJoint] = 0;
  segment.from.structure_weight_motion[kJoint] = -kMotion;
  segment.to.structure_weight_motion[kJoint] = kMotion;
  const double attained = 2 * kLever * kJointSpeed * 2 * kMotion * kSpeed;
  const double bound = segment.curvature({kJointSpeed, kSpeed, 0});
  TEST_ASSERT_TRUE(bound >= attained);
  TEST_ASSERT_TRUE(bound < 1.01 * attained);
}

/// The blend speeds up: torque and motion change by it, at a lever that stays.
void a_blend_that_speeds_up_bends_torque_and_motion() {
  constexpr double kAcceleration = 3;
  Segment segment;
  segment.from.weight_torque[kJoint] = -kTorque;
  segment.to.weight_torque[kJoint] = kTorque;
  segment.from.structure_weight_motion[kJoint] = -kMotion;
  segment.to.structure_weight_motion[kJoint] = kMotion;
  const double attained = kLever * kAcceleration * 2 * (kCompliance * kTorque + kMotion);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12 * attained, attained, segment.curvature({0, 0, kAcceleration}));
}

/// c3 τ³ with a torque that passes zero at the speed of the blend: 6 c3 τ (τ')², τ at most T.
void a_cubic_spring_bends_with_the_square_of_the_torque_s_speed() {
  constexpr double kSpeed = 2, kCubic = 1e-13;  // rad/(N·m)³
  Segment segment;
  segment.bounds.compliance[kJoint] = 0;
  segment.bounds.cubic[kJoint] = kCubic * kTorque;
  segment.from.weight_torque[kJoint] = -kTorque;
  segment.to.weight_torque[kJoint] = kTorque;
  const double speed = 2 * kTorque * kSpeed;
  const double at_the_end = 6 * kCubic * kLever * kTorque * speed * speed;
  TEST_ASSERT_DOUBLE_WITHIN(1e-12 * at_the_end, at_the_end, segment.curvature({0, kSpeed, 0}));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_blend_of_levers_bends_as_their_square_does);
  RUN_TEST(a_blended_torque_at_a_lever_that_turns_bends_by_both_speeds);
  RUN_TEST(a_blended_motion_at_a_lever_that_turns_bends_by_both_speeds);
  RUN_TEST(a_blend_that_speeds_up_bends_torque_and_motion);
  RUN_TEST(a_cubic_spring_bends_with_the_square_of_the_torque_s_speed);
  return UNITY_END();
}
