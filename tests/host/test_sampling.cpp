// Rows that repeat a sample and times that are not those of the samples, against the clock by which
// made-up joints were sampled.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "recording/sampling.hpp"
#include "unity_main.hpp"

using Eigen::Index;
using Eigen::VectorXd;
using flexcomp::recording::picked;
using flexcomp::recording::Recording;
using flexcomp::recording::Samples;
using flexcomp::recording::Sampling;
using flexcomp::recording::sampling_of;

namespace {

constexpr Index kRows = 600;
constexpr Index kJoints = 3;
constexpr double kLogged = 0.030;     // s, between rows
constexpr double kAnswered = 0.0311;  // s, between samples

double angle_of(Index joint, double time) {
  const double omega = 0.7 + 0.4 * static_cast<double>(joint);
  return 0.8 * std::sin(omega * time + static_cast<double>(joint)) + 0.2 * std::sin(2.3 * time);
}

VectorXd even(Index rows, double step) {
  return VectorXd::LinSpaced(rows, 0, step * static_cast<double>(rows - 1));
}

/// What the joints show at some times.
Samples at(const VectorXd& times) {
  Samples angles(times.size(), kJoints);
  for (Index row = 0; row < times.size(); ++row) {
    for (Index joint = 0; joint < kJoints; ++joint) {
      angles(row, joint) = angle_of(joint, times[row]);
    }
  }
  return angles;
}

/// When the sample of each row was taken by a robot that answers more slowly than it is asked.
VectorXd answered() { return kAnswered * (even(kRows, kLogged).array() / kAnswered + 0.5).floor(); }

void a_sample_that_a_log_shows_twice_is_found_where_joints_move() {
  const VectorXd taken = answered();
  const Sampling sampling = sampling_of(even(kRows, kLogged), at(taken));
  std::vector<Index> expected;
  for (Index row = 1; row < kRows; ++row) {
    if (taken[row] == taken[row - 1]) {
      expected.push_back(row);
    }
  }
  TEST_ASSERT_TRUE(expected.size() > 15);
  // Near the turn of a joint its steps are no steady motion; others move on there.
  TEST_ASSERT_TRUE(sampling.repeats == expected);
  TEST_ASSERT_EQUAL_INT64(kRows, static_cast<Index>(sampling.rows.size() + expected.size()));
}

/// Rows of which each shows the sample of another, and which of them must be found; at the ends of
/// a recording nobody knows how a joint moves.
void assert_repeats_are_found(const VectorXd& times, const std::vector<Index>& shown) {
  const Samples whole = at(times);
  const Sampling sampling = sampling_of(times, whole(shown, Eigen::all));
  std::vector<Index> expected;
  for (Index row = 1; row < times.size(); ++row) {
    const Index own = shown[static_cast<std::size_t>(row)];
    if (own < row && own > shown.front() && own < shown.back()) {
      expected.push_back(row);
    }
  }
  TEST_ASSERT_TRUE(expected.size() > 100);
  TEST_ASSERT_TRUE(std::includes(sampling.repeats.begin(), sampling.repeats.end(), expected.begin(),
                                 expected.end()));
}

void a_log_several_times_as_fast_as_the_robot_repeats_each_sample() {
  for (const Index each : {2, 3, 8}) {
    std::vector<Index> shown;
    for (Index row = 0; row < kRows; ++row) {
      shown.push_back(row / each * each);
    }
    assert_repeats_are_found(even(kRows, 0.004), shown);
  }
}

void samples_that_come_at_odd_moments_are_repeated_until_the_next() {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> chance(0, 1);
  std::vector<Index> shown;
  for (Index row = 0; row < kRows; ++row) {
    shown.push_back(row == 0 || chance(random) < 0.6 ? row : shown.back());
  }
  assert_repeats_are_found(even(kRows, 0.004), shown);
}

void times_are_those_of_the_samples_then() {
  const VectorXd taken = answered();
  const Sampling sampling = sampling_of(even(kRows, kLogged), at(taken));
  TEST_ASSERT_DOUBLE_WITHIN(1e-5, kAnswered, sampling.period);
  for (std::size_t i = 1; i < sampling.rows.size(); ++i) {
    const double step =
        sampling.time[static_cast<Index>(i)] - sampling.time[static_cast<Index>(i) - 1];
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, kAnswered, step);
  }
}

void stamps_that_jitter_are_evened() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> late(0, 0.01);
  const VectorXd taken = even(kRows, kLogged);
  VectorXd stamps = taken;
  for (double& stamp : stamps) {
    stamp += late(random);
  }
  const Sampling sampling = sampling_of(stamps, at(taken));
  TEST_ASSERT_TRUE(sampling.repeats.empty());
  TEST_ASSERT_DOUBLE_WITHIN(2e-5, kLogged, sampling.period);
  for (Index row = 1; row < kRows; ++row) {
    TEST_ASSERT_DOUBLE_WITHIN(2e-5, kLogged, sampling.time[row] - sampling.time[row - 1]);
  }
}

void times_that_are_uneven_indeed_stay() {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> late(0, 0.01);
  VectorXd times = even(kRows, kLogged);
  for (double& time : times) {
    time += late(random);
  }
  const Sampling sampling = sampling_of(times, at(times));
  TEST_ASSERT_TRUE(sampling.time == times);
  TEST_ASSERT_EQUAL_DOUBLE(0, sampling.period);
}

void times_that_were_rounded_in_the_file_stay() {
  const VectorXd taken = even(kRows, kLogged);
  VectorXd stamps = taken;
  for (Index row = 0; row < kRows; ++row) {
    stamps[row] += 1e-5 * kLogged * static_cast<double>(row % 3);
  }
  TEST_ASSERT_TRUE(sampling_of(stamps, at(taken)).time == stamps);
}

void a_gap_stays_where_the_times_about_it_are_evened() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> late(0, 0.01);
  VectorXd taken = even(kRows, kLogged);
  taken.tail(kRows / 2).array() += 1.5;
  VectorXd stamps = taken;
  for (double& stamp : stamps) {
    stamp += late(random);
  }
  const Sampling sampling = sampling_of(stamps, at(taken));
  TEST_ASSERT_TRUE(sampling.period > 0);
  const double gap = sampling.time[kRows / 2] - sampling.time[kRows / 2 - 1];
  TEST_ASSERT_DOUBLE_WITHIN(0.003, 1.5 + kLogged, gap);
}

void a_dwell_repeats_nothing() {
  // Up, a rest of a second, and on, with ramps of 0.3 s.
  VectorXd angle(kRows);
  for (Index row = 0; row < kRows; ++row) {
    const double time = kLogged * static_cast<double>(row);
    const auto ramped = [](double t) { return t < 0 ? 0.0 : t < 0.3 ? t * t / 0.6 : t - 0.15; };
    angle[row] = ramped(time - 1) - ramped(time - 4) + ramped(time - 5);
  }
  Samples angles = Samples::Zero(kRows, kJoints);
  angles.col(1) = angle;
  const Sampling sampling = sampling_of(even(kRows, kLogged), angles);
  TEST_ASSERT_TRUE(sampling.repeats.empty());
}

void steps_of_an_encoder_repeat_nothing() {
  constexpr double kCount = 1e-3;  // rad
  const VectorXd times = even(kRows, kLogged);
  for (const double speed : {0.01, 0.04, 0.1}) {  // rad/s: up to three counts a row
    Samples angles = Samples::Zero(kRows, kJoints);
    angles.col(0) = kCount * (speed * times.array() / kCount).round();
    angles.col(2) = kCount * (1.3 * speed * times.array() / kCount).round();
    TEST_ASSERT_TRUE(sampling_of(times, angles).repeats.empty());
  }
}

void rows_that_are_picked_keep_all_they_have() {
  Recording recording;
  recording.file = "made.csv";
  recording.lines = {2, 3, 5};
  recording.time = even(3, 1);
  recording.q_meas = at(recording.time);
  recording.wrench = Samples::Constant(3, 6, 7);
  const Recording some = picked(recording, {0, 2});
  TEST_ASSERT_EQUAL_INT64(2, some.size());
  TEST_ASSERT_EQUAL_UINT64(5, some.lines[1]);
  TEST_ASSERT_TRUE(some.q_meas->row(1) == recording.q_meas->row(2));
  TEST_ASSERT_EQUAL_INT64(2, some.wrench->rows());
  TEST_ASSERT_FALSE(some.tau.has_value());
}

Recording logged(const VectorXd& time, const VectorXd& taken) {
  Recording recording;
  recording.time = time;
  recording.q_meas = at(taken);
  return recording;
}

void a_recording_that_lacks_some_angles_is_sampled_by_the_others() {
  const VectorXd taken = answered();
  Recording recording = logged(even(kRows, kLogged), taken);
  const Sampling whole = sampling_of(recording);
  TEST_ASSERT_TRUE(whole.repeats == sampling_of(recording.time, *recording.q_meas).repeats);
  const Index missing = 2;
  (*recording.q_meas)(missing, 1) = std::nan("");
  const Sampling sampling = sampling_of(recording);
  TEST_ASSERT_TRUE(sampling.repeats == whole.repeats);
  TEST_ASSERT_EQUAL_INT64(missing + 1, sampling.rows[missing]);
  TEST_ASSERT_EQUAL_UINT64(whole.rows.size() - 1, sampling.rows.size());
}

void commands_and_load_tests_repeat_nothing() {
  Recording commanded = logged(even(kRows, kLogged), answered());
  commanded.q_cmd.swap(commanded.q_meas);
  TEST_ASSERT_TRUE(sampling_of(commanded).repeats.empty());
  TEST_ASSERT_TRUE(sampling_of(commanded).time == commanded.time);
  Recording posed = logged(even(kRows, 1), answered());
  TEST_ASSERT_TRUE(sampling_of(posed).repeats.empty());
  posed.time *= 0.5;
  TEST_ASSERT_FALSE(sampling_of(posed).repeats.empty());
}

void steps_are_regular_if_few_are_longer() {
  using flexcomp::recording::regular_step;
  TEST_ASSERT_FALSE(regular_step({}).has_value());
  TEST_ASSERT_EQUAL_INT64(3, *regular_step({3, 2, 3, 4, 3, 3, 4, 3, 3, 3}));
  TEST_ASSERT_EQUAL_INT64(1, *regular_step({1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 50}));
  TEST_ASSERT_FALSE(regular_step({1, 1, 1, 1, 1, 1, 1, 1, 30, 50}).has_value());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_sample_that_a_log_shows_twice_is_found_where_joints_move);
  RUN_TEST(a_log_several_times_as_fast_as_the_robot_repeats_each_sample);
  RUN_TEST(samples_that_come_at_odd_moments_are_repeated_until_the_next);
  RUN_TEST(times_are_those_of_the_samples_then);
  RUN_TEST(stamps_that_jitter_are_evened);
  RUN_TEST(times_that_are_uneven_indeed_stay);
  RUN_TEST(times_that_were_rounded_in_the_file_stay);
  RUN_TEST(a_gap_stays_where_the_times_about_it_are_evened);
  RUN_TEST(a_dwell_repeats_nothing);
  RUN_TEST(steps_of_an_encoder_repeat_nothing);
  RUN_TEST(rows_that_are_picked_keep_all_they_have);
  RUN_TEST(a_recording_that_lacks_some_angles_is_sampled_by_the_others);
  RUN_TEST(commands_and_load_tests_repeat_nothing);
  RUN_TEST(steps_are_regular_if_few_are_longer);
  return UNITY_END();
}
