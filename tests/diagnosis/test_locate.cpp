// Where a mismatch is: errors of known place, put on top of a recording with noise.
#include <algorithm>
#include <string>

#include "diagnosis/locate.hpp"
#include "diagnosis/swinging_robot.hpp"
#include "unity_main.hpp"

using flexcomp::diagnosis::locate;
using flexcomp::diagnosis::Location;
using flexcomp::diagnosis::Observations;
using flexcomp::test::SwingingRobot;

namespace {

constexpr double kPi = 3.14159265358979323846;

Location location_of(const SwingingRobot& swinging, const Eigen::MatrixXd& error) {
  const Observations observations = swinging.observed(error);
  return locate(observations, observations.residual);
}

Eigen::MatrixXd along(Eigen::Index axis, const Eigen::VectorXd& error) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(error.size(), 3);
  all.col(axis) = error;
  return all;
}

void nothing_is_located_in_noise() {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const SwingingRobot swinging(seed);
    const Observations observations = swinging.observed();
    const Location location = locate(observations, observations.residual);
    TEST_ASSERT_TRUE(location.joints.empty());
    TEST_ASSERT_TRUE(location.axes.empty());
    TEST_ASSERT_TRUE(location.time.empty());
    TEST_ASSERT_TRUE(location.frequency_hz.empty());
    TEST_ASSERT_TRUE(location.correlates_with.empty());
  }
}

void an_error_that_turns_with_a_joint_is_located_at_its_direction_of_motion() {
  const SwingingRobot swinging(1);
  const Eigen::VectorXd side = swinging.scene.velocity.col(2).array().sign();
  const Location location = location_of(swinging, swinging.moved_by(3, 3e-5 * side));
  TEST_ASSERT_EQUAL_STRING("direction of motion of joint 3",
                           location.correlates_with.front().cue.c_str());
  TEST_ASSERT_EQUAL_INT(3, location.joints.front());
  TEST_ASSERT_TRUE(location.correlates_with.front().share > 0.8);
}

void an_error_after_each_reversal_is_located_at_the_time_since_it() {
  const SwingingRobot swinging(2);
  const Eigen::VectorXd speed = swinging.scene.velocity.col(4);
  Eigen::VectorXd error(speed.size());
  double turned = -1e9;
  for (Eigen::Index row = 0; row < speed.size(); ++row) {
    const double time = swinging.recording.time[row];
    if (row > 0 && speed[row] * speed[row - 1] < 0) {
      turned = time;
    }
    error[row] = 2e-4 * std::exp(-(time - turned) / 0.1);
  }
  const Location location = location_of(swinging, swinging.moved_by(5, error));
  TEST_ASSERT_EQUAL_STRING("time since the reversal of joint 5",
                           location.correlates_with.front().cue.c_str());
}

void an_error_of_an_angle_is_located_at_that_angle() {
  const SwingingRobot swinging(3);
  const Eigen::VectorXd q = swinging.scene.q.col(1);
  const Location location =
      location_of(swinging, swinging.moved_by(2, 2e-5 * (6 * q.array()).sin()));
  TEST_ASSERT_EQUAL_STRING("angle of joint 2", location.correlates_with.front().cue.c_str());
}

void a_vibration_is_located_at_its_axis_and_frequency() {
  const SwingingRobot swinging(4);
  const Eigen::VectorXd& time = swinging.recording.time;
  const Location location =
      location_of(swinging, along(1, 2e-5 * (2 * kPi * 7.3 * time.array()).sin()));
  TEST_ASSERT_EQUAL_UINT64(1, location.axes.size());
  TEST_ASSERT_EQUAL_STRING("y", location.axes.front().c_str());
  TEST_ASSERT_EQUAL_UINT64(1, location.frequency_hz.size());
  TEST_ASSERT_DOUBLE_WITHIN(1 / time[time.size() - 1], 7.3, location.frequency_hz.front());
}

void a_burst_is_located_at_its_time() {
  const SwingingRobot swinging(5);
  const Eigen::VectorXd& time = swinging.recording.time;
  const Eigen::VectorXd inside =
      (time.array() > 15 && time.array() < 20).cast<double>() * (9 * time.array()).cos();
  const Location location = location_of(swinging, along(2, 5e-5 * inside));
  TEST_ASSERT_EQUAL_UINT64(1, location.time.size());
  TEST_ASSERT_DOUBLE_WITHIN(40.0 / 24, 15, location.time.front().first);
  TEST_ASSERT_DOUBLE_WITHIN(40.0 / 24, 20, location.time.front().second);
}

void growth_with_warmth_is_located_at_the_temperature() {
  SwingingRobot swinging(6);
  const Eigen::ArrayXd time = swinging.recording.time.array();
  const Eigen::VectorXd warmth = 25 + 3 * (time / 6).sin() + 2 * (time / 2.3).cos();
  swinging.recording.temperature = warmth;
  const Location location = location_of(swinging, along(0, 1e-5 * (warmth.array() - 25)));
  TEST_ASSERT_EQUAL_STRING("temperature", location.correlates_with.front().cue.c_str());
  TEST_ASSERT_EQUAL_STRING("x", location.axes.front().c_str());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(nothing_is_located_in_noise);
  RUN_TEST(an_error_that_turns_with_a_joint_is_located_at_its_direction_of_motion);
  RUN_TEST(an_error_after_each_reversal_is_located_at_the_time_since_it);
  RUN_TEST(an_error_of_an_angle_is_located_at_that_angle);
  RUN_TEST(a_vibration_is_located_at_its_axis_and_frequency);
  RUN_TEST(a_burst_is_located_at_its_time);
  RUN_TEST(growth_with_warmth_is_located_at_the_temperature);
  return UNITY_END();
}
