// Noise of a signal told apart from its motion, whole or with samples in few rows only, or in
// counts.
#include <cmath>
#include <limits>
#include <random>

#include "recording/noise.hpp"
#include "unity_main.hpp"

using Eigen::Index;
using Eigen::VectorXd;
using flexcomp::recording::encoder_noise;
using flexcomp::recording::quantisation_step;
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

constexpr double kCount = 4e-4;  // rad, of a coarse encoder

VectorXd times() { return VectorXd::LinSpaced(4000, 0, 39.99); }

VectorXd in_counts(const VectorXd& angle) { return kCount * (angle / kCount).array().round(); }

void the_count_of_a_coarse_encoder_is_found() {
  for (const double swing : {0.01, 0.1, 0.3, 0.8}) {  // rad
    const VectorXd angle = 0.2 + swing * (3 * times().array()).sin();
    TEST_ASSERT_DOUBLE_WITHIN(1e-9 * kCount, kCount, quantisation_step(in_counts(angle)));
  }
}

void what_is_smooth_has_no_count_though_its_values_come_again() {
  const VectorXd swing = (3 * times().array()).sin();
  VectorXd periodic(times().size());
  for (Index row = 0; row < periodic.size(); ++row) {
    periodic[row] = swing[row % 100];
  }
  TEST_ASSERT_EQUAL_DOUBLE(0, quantisation_step(swing));
  TEST_ASSERT_EQUAL_DOUBLE(0, quantisation_step(periodic));
  TEST_ASSERT_EQUAL_DOUBLE(0, quantisation_step(VectorXd::Constant(100, 0.7)));
}

/// An error that is spread evenly over a count has its size over √12 for a deviation; of a creep,
/// whose readings are mostly the same as their neighbours, nothing else shows it.
void the_noise_of_an_encoder_is_no_less_than_that_of_rounding() {
  const double rounding = kCount / std::sqrt(12.0);
  const VectorXd swing = 0.3 * (3 * times().array()).sin();
  TEST_ASSERT_TRUE(encoder_noise(times(), in_counts(swing)) >= rounding * (1 - 1e-9));
  TEST_ASSERT_TRUE(encoder_noise(times(), in_counts(swing)) < 1.5 * rounding);
  TEST_ASSERT_DOUBLE_WITHIN(1e-6 * rounding, rounding,
                            encoder_noise(times(), in_counts(0.0005 * times())));
  TEST_ASSERT_TRUE(encoder_noise(times(), swing) < 1e-6);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(noise_is_known_to_a_tenth_whole_or_in_few_rows);
  RUN_TEST(a_stride_counts_rows_though_samples_are_in_few);
  RUN_TEST(a_signal_that_is_not_there_has_no_noise);
  RUN_TEST(a_sample_far_off_stands_alone_whole_or_in_few_rows);
  RUN_TEST(the_count_of_a_coarse_encoder_is_found);
  RUN_TEST(what_is_smooth_has_no_count_though_its_values_come_again);
  RUN_TEST(the_noise_of_an_encoder_is_no_less_than_that_of_rounding);
  return UNITY_END();
}
