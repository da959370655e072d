// Noise of a signal told apart from its motion, whole or with samples in few rows only.
#include <cmath>
#include <limits>
#include <random>

#include "recording/noise.hpp"
#include "unity_main.hpp"

using Eigen::Index;
using Eigen::VectorXd;
using flexcomp::recording::stands_alone;
using flexcomp::recording::white_noise;

namespace {

constexpr double kDeviation = 2e-5;
constexpr Index kRows = 40000;

/// A wave of 1 mm with noise of 20 µm, in every so many rows.
VectorXd noisy_wave(Index each) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, kDeviation);
  VectorXd signal = VectorXd::Constant(kRows, std::numeric_limits<double>::quiet_NaN());
  for (Index row = 0; row < kRows; row += each) {
    signal[row] = 1e-3 * std::sin(0.0005 * static_cast<double>(row)) + noise(random);
  }
  return signal;
}

void noise_is_known_to_a_tenth_whole_or_in_few_rows() {
  for (const Index each : {1, 2, 7}) {
    TEST_ASSERT_DOUBLE_WITHIN(0.1 * kDeviation, kDeviation, white_noise(noisy_wave(each)));
  }
}

void a_stride_counts_rows_though_samples_are_in_few() {
  TEST_ASSERT_EQUAL_DOUBLE(white_noise(noisy_wave(7)), white_noise(noisy_wave(7), 13));
  TEST_ASSERT_TRUE(white_noise(noisy_wave(7)) != white_noise(noisy_wave(7), 14));
}

void a_signal_that_is_not_there_has_no_noise() {
  TEST_ASSERT_EQUAL_DOUBLE(
      0, white_noise(VectorXd::Constant(kRows, std::numeric_limits<double>::quiet_NaN())));
}

void a_sample_far_off_stands_alone_whole_or_in_few_rows() {
  for (const Index each : {1, 2, 7}) {
    VectorXd signal = noisy_wave(each);
    const Index row = 70 * each;
    TEST_ASSERT_FALSE(stands_alone(signal, row, kDeviation));
    signal[row] += 1e-3;
    TEST_ASSERT_TRUE(stands_alone(signal, row, kDeviation));
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(noise_is_known_to_a_tenth_whole_or_in_few_rows);
  RUN_TEST(a_stride_counts_rows_though_samples_are_in_few);
  RUN_TEST(a_signal_that_is_not_there_has_no_noise);
  RUN_TEST(a_sample_far_off_stands_alone_whole_or_in_few_rows);
  return UNITY_END();
}
