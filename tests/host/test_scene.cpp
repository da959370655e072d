// How a recording is made ready: derivatives against closed forms, what is left out, what is
// doubted.
#include <cmath>
#include <cstring>
#include <limits>

#include "error.hpp"
#include "simulation/scene.hpp"
#include "unity_main.hpp"

using Eigen::Index;
using Eigen::VectorXd;
using flexcomp::recording::Recording;
using flexcomp::recording::Samples;
using flexcomp::simulation::Preparation;
using flexcomp::simulation::prepare;
using flexcomp::simulation::Scene;

namespace {

constexpr double kPi = 3.14159265358979323846;

/// All joints at rest but joint 1, which follows `angle`; torques are there to compare with.
Recording recording_of(const VectorXd& time, const VectorXd& angle) {
  Recording recording;
  recording.file = "made.csv";
  recording.time = time;
  recording.q_meas = Samples::Zero(time.size(), 6);
  recording.q_meas->col(0) = angle;
  recording.tau = Samples::Zero(time.size(), 6);
  return recording;
}

VectorXd times(Index rows, double step) {
  return VectorXd::LinSpaced(rows, 0, step * static_cast<double>(rows - 1));
}

Scene scene_of(const Recording& recording) {
  Preparation preparation;
  return prepare(recording, recording.size(), &preparation);
}

/// A move whose acceleration rises and falls as 1 − cos in 0.1 s, at 1 s and back at 2 s.
struct Ramp {
  VectorXd angle, acceleration;

  explicit Ramp(const VectorXd& time) : angle(time.size()), acceleration(time.size()) {
    for (Index row = 0; row < time.size(); ++row) {
      angle[row] = position(time[row] - 1) - position(time[row] - 2);
      acceleration[row] = second(time[row] - 1) - second(time[row] - 2);
    }
  }

  static constexpr double kLength = 0.1;  // s

  static double position(double t) {
    const double share = std::min(std::max(t / kLength, 0.0), 1.0);
    const double wave = std::cos(2 * kPi * share) - 1;
    return kLength * (share * share / 2 + wave / (4 * kPi * kPi)) + std::max(t - kLength, 0.0);
  }

  static double second(double t) {
    return t < 0 || t > kLength ? 0 : (1 - std::cos(2 * kPi * t / kLength)) / kLength;
  }
};

/// A swing of joint 1 with the TCP measured in every third row.
Recording slowly_tracked(bool holds) {
  const VectorXd time = times(600, 0.004);
  Recording recording = recording_of(time, (2 * time.array()).sin());
  recording.tau.reset();
  recording.position = Samples::Constant(time.size(), 3, std::numeric_limits<double>::quiet_NaN());
  for (Index row = 0; row < time.size(); ++row) {
    if (row % 3 == 1) {
      recording.position->row(row).setConstant(std::sin(2 * time[row]));
    } else if (holds && row > 1) {
      recording.position->row(row) = recording.position->row(row - 1);
    }
  }
  return recording;
}

void a_sample_that_a_slow_sensor_repeats_counts_once() {
  const Scene held = scene_of(slowly_tracked(true));
  const Scene missing = scene_of(slowly_tracked(false));
  const auto& position = held.measured[flexcomp::simulation::tcp_position];
  TEST_ASSERT_EQUAL_INT(200 * 3, position.array().isFinite().count());
  const Eigen::ArrayXXd difference =
      (position - missing.measured[flexcomp::simulation::tcp_position]).array();
  TEST_ASSERT_EQUAL_INT(200 * 3, (difference == 0).count());
}

void torque_that_stays_the_same_in_a_motion_is_not_taken_for_repeats() {
  const VectorXd time = times(600, 0.004);
  Recording recording = recording_of(time, (2 * time.array()).sin());
  for (Index row = 0; row < time.size(); ++row) {
    recording.tau->row(row).setConstant(std::cos(2 * time[row]) > 0 ? 1 : -1);
  }
  const Scene scene = scene_of(recording);
  TEST_ASSERT_TRUE(scene.measured[flexcomp::simulation::joint_torque].allFinite());
}

void of_many_rows_those_are_used_that_show_something() {
  Preparation preparation;
  const Scene scene = prepare(slowly_tracked(false), 200, &preparation);
  TEST_ASSERT_EQUAL_INT(200, scene.rows());
  TEST_ASSERT_TRUE(scene.measured[flexcomp::simulation::tcp_position].allFinite());
}

void derivatives_of_a_swing_are_its_own_at_uneven_times() {
  VectorXd time = times(2000, 0.004);
  for (Index row = 0; row < time.size(); ++row) {
    time[row] += 0.001 * std::sin(static_cast<double>(row * row));
  }
  const double omega = 2 * kPi * 0.7;
  const Scene scene = scene_of(recording_of(time, (omega * time.array()).sin()));
  const VectorXd velocity = omega * (omega * time.array()).cos();
  const VectorXd acceleration = -omega * omega * (omega * time.array()).sin();
  TEST_ASSERT_TRUE((scene.velocity.col(0) - velocity).cwiseAbs().maxCoeff() < 1e-6 * omega);
  TEST_ASSERT_TRUE((scene.acceleration.col(0) - acceleration).cwiseAbs().maxCoeff() <
                   1e-4 * omega * omega);
}

void accelerations_are_doubted_where_ramps_are_too_abrupt_for_the_samples() {
  const VectorXd time = times(300, 0.01);
  const Ramp ramp(time);
  const Scene scene = scene_of(recording_of(time, ramp.angle));
  const VectorXd error = scene.acceleration.col(0) - ramp.acceleration;
  const VectorXd doubt = scene.acceleration_doubt.col(0);
  TEST_ASSERT_TRUE(error.norm() > 0.01 * ramp.acceleration.norm());  // it does matter
  TEST_ASSERT_TRUE(doubt.norm() > 0.5 * error.norm());
  TEST_ASSERT_TRUE(doubt.norm() < 3 * error.norm());
}

void the_same_ramps_are_not_doubted_with_ten_times_the_samples() {
  const VectorXd time = times(3000, 0.001);
  const Ramp ramp(time);
  const Scene scene = scene_of(recording_of(time, ramp.angle));
  TEST_ASSERT_TRUE(scene.acceleration_doubt.col(0).norm() < 0.01 * ramp.acceleration.norm());
}

void steps_of_an_encoder_are_noise_and_no_doubt() {
  constexpr double kStep = 1e-6;  // rad
  const VectorXd time = times(2000, 0.004);
  const VectorXd swing = (2 * kPi * 0.2 * time.array()).sin();
  const VectorXd angle = kStep * (swing / kStep).array().round();
  const Scene scene = scene_of(recording_of(time, angle));
  // At the ends windows have but one side, and cut more of the motion than the steps are.
  const auto end = static_cast<Index>(scene.half_window / 0.004) + 1;
  const auto inner = scene.acceleration_doubt.col(0).segment(end, time.size() - 2 * end);
  TEST_ASSERT_TRUE((inner.array() != 0).count() < time.size() / 100);
  const double expected = scene.acceleration_noise[0];
  const VectorXd exact = -std::pow(2 * kPi * 0.2, 2) * swing;
  const VectorXd error = (scene.acceleration.col(0) - exact).segment(end, time.size() - 2 * end);
  const double actual = error.norm() / std::sqrt(static_cast<double>(error.size()));
  // Steps are not normally distributed: the robust estimate of their size is a fifth low.
  TEST_ASSERT_DOUBLE_WITHIN(0.35 * expected, expected, actual);
}

void a_joint_that_stands_has_no_speed_and_is_said_to_stand() {
  const VectorXd time = times(300, 0.01);
  const Scene scene = scene_of(recording_of(time, Ramp(time).angle));
  TEST_ASSERT_TRUE(scene.velocity.col(3).isZero(0));
  TEST_ASSERT_EQUAL_INT(1, scene.stands(150, 3));
  TEST_ASSERT_EQUAL_INT(0, scene.stands(150, 0));
  TEST_ASSERT_EQUAL_INT(1, scene.stands(50, 0));
}

void rows_without_all_angles_are_left_out_and_counted() {
  const VectorXd time = times(100, 0.01);
  Recording recording = recording_of(time, time);
  (*recording.q_meas)(40, 2) = std::numeric_limits<double>::quiet_NaN();
  Preparation preparation;
  const Scene scene = prepare(recording, 30, &preparation);
  TEST_ASSERT_EQUAL_INT64(100, preparation.rows);
  TEST_ASSERT_EQUAL_INT64(1, preparation.incomplete);
  TEST_ASSERT_EQUAL_INT64(4, preparation.kept_each);
  TEST_ASSERT_EQUAL_INT64(25, scene.rows());
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.01, preparation.median_step);
}

void whole_numbers_of_time_are_a_load_test_without_motion() {
  const VectorXd time = times(12, 1);
  const Scene scene = scene_of(recording_of(time, 0.1 * time));
  TEST_ASSERT_TRUE(scene.is_static);
  TEST_ASSERT_TRUE(scene.velocity.isZero(0));
}

void what_cannot_be_compared_is_refused() {
  const VectorXd time = times(12, 0.01);
  Recording recording = recording_of(time, time);
  recording.tau.reset();
  Preparation preparation;
  try {
    prepare(recording, 12, &preparation);
    TEST_FAIL_MESSAGE("not refused");
  } catch (const flexcomp::InputError& error) {
    TEST_ASSERT_NOT_NULL(strstr(error.what(), "nothing to compare with"));
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_sample_that_a_slow_sensor_repeats_counts_once);
  RUN_TEST(torque_that_stays_the_same_in_a_motion_is_not_taken_for_repeats);
  RUN_TEST(of_many_rows_those_are_used_that_show_something);
  RUN_TEST(derivatives_of_a_swing_are_its_own_at_uneven_times);
  RUN_TEST(accelerations_are_doubted_where_ramps_are_too_abrupt_for_the_samples);
  RUN_TEST(the_same_ramps_are_not_doubted_with_ten_times_the_samples);
  RUN_TEST(steps_of_an_encoder_are_noise_and_no_doubt);
  RUN_TEST(a_joint_that_stands_has_no_speed_and_is_said_to_stand);
  RUN_TEST(rows_without_all_angles_are_left_out_and_counted);
  RUN_TEST(whole_numbers_of_time_are_a_load_test_without_motion);
  RUN_TEST(what_cannot_be_compared_is_refused);
  return UNITY_END();
}
