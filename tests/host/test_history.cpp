// Physics that remembers, against closed forms.
#include <unity.h>

#include <cmath>

#include "simulation/history.hpp"

using Eigen::VectorXd;
namespace history = flexcomp::simulation;

void setUp() {}
void tearDown() {}

namespace {

VectorXd triangle(double height) {  // up, down to −height, up again
  VectorXd values(401);
  for (int i = 0; i <= 400; ++i) {
    const double phase = i / 100.0;
    values[i] = height * (phase < 1 ? phase : phase < 3 ? 2 - phase : phase - 4);
  }
  return values;
}

VectorXd times(int count, double step) { return VectorXd::LinSpaced(count, 0, step * (count - 1)); }

void play_follows_with_half_the_gap_on_either_side() {
  const VectorXd input = triangle(1);
  const VectorXd output = history::play(input, 0.2);
  TEST_ASSERT_EQUAL_DOUBLE(0, output[10]);  // within the gap nothing moves
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.8, output[100]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.8, output[130]);  // held after the reversal
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, input[200] + 0.2, output[200]);
}

void a_flank_changes_over_beyond_the_drag_only() {
  const VectorXd torque = triangle(100);
  const VectorXd side = history::flank(torque, 30);
  TEST_ASSERT_EQUAL_DOUBLE(1, side[0]);
  TEST_ASSERT_EQUAL_DOUBLE(1, side[229]);   // at −29
  TEST_ASSERT_EQUAL_DOUBLE(-1, side[231]);  // at −31
  TEST_ASSERT_EQUAL_DOUBLE(-1, side[400]);  // back at 0
}

void bouc_wen_rises_to_one_as_an_exponential_and_does_not_depend_on_the_sampling() {
  VectorXd coarse(2);
  coarse << 0, 50;
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1 - std::exp(-2.0), history::bouc_wen(coarse, 25)[1]);
  const VectorXd fine = VectorXd::LinSpaced(1000, 0, 50);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1 - std::exp(-2.0), history::bouc_wen(fine, 25)[999]);
}

void a_loop_of_bouc_wen_closes_on_itself() {
  VectorXd twice(800);
  twice << triangle(10).head(400), triangle(10).head(400);
  const VectorXd loop = history::bouc_wen(twice, 1);
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, loop[300], loop[700]);
}

void prandtl_ishlinskii_begins_as_a_spring_and_ends_saturated() {
  const VectorXd torque = triangle(1000);
  const VectorXd loop = history::prandtl_ishlinskii(torque, 50);
  // While no element slips the slope is the sum of all.
  double slope = 0;
  for (int element = 0; element < 10; ++element) {
    slope += 1 / (200 * (element + 0.5) / 10) / 10;
  }
  VectorXd little(2);
  little << 0, 5;
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5 * slope, history::prandtl_ishlinskii(little, 50)[1]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1, loop[100]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, -1, loop[300]);
}

void the_yield_of_a_loop_is_by_how_much_it_is_complete_later_than_at_once() {
  constexpr double kYield = 80;
  constexpr double kStep = 0.1;
  const VectorXd torque = VectorXd::LinSpaced(30001, 0, 30000 * kStep);
  for (const auto loop : {&history::bouc_wen, &history::prandtl_ishlinskii}) {
    const VectorXd missing = 1 - loop(torque, kYield).array();
    const double integral = kStep * (missing.sum() - 0.5 * (missing[0] + missing[30000]));
    TEST_ASSERT_DOUBLE_WITHIN(1e-4 * kYield, kYield, integral);
  }
}

void a_mode_rings_at_its_frequency_and_dies_out_at_its_damping() {
  constexpr double kFrequency = 7;
  constexpr double kDamping = 0.05;
  const VectorXd time = times(2001, 0.001);
  VectorXd input = VectorXd::Ones(2001);
  input[0] = 0;  // a step within the first millisecond
  const VectorXd response = history::mode(time, input, kFrequency, kDamping);
  const double omega = 2 * M_PI * kFrequency;
  const double damped = omega * std::sqrt(1 - kDamping * kDamping);
  for (const int row : {300, 700, 1500}) {
    const double t = time[row] - 0.0005;  // the ramp's middle
    const double expected =
        1 - std::exp(-kDamping * omega * t) *
                (std::cos(damped * t) + kDamping * omega / damped * std::sin(damped * t));
    TEST_ASSERT_DOUBLE_WITHIN(2e-4, expected, response[row]);
  }
}

void a_mode_does_not_depend_on_even_steps() {
  VectorXd time = times(1000, 0.002);
  VectorXd uneven = time;
  for (Eigen::Index i = 1; i + 1 < uneven.size(); ++i) {
    uneven[i] += 0.0005 * std::sin(37.0 * static_cast<double>(i));
  }
  // Both are exact for a straight input.
  const VectorXd even_response = history::mode(time, 3 * time, 4, 0.02);
  const VectorXd uneven_response = history::mode(uneven, 3 * uneven, 4, 0.02);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, even_response[999], uneven_response[999]);
}

void a_mode_whose_frequency_doubles_rings_twice_as_fast_from_there_on() {
  const VectorXd time = times(4001, 0.001);
  VectorXd input = VectorXd::Zero(4001);
  input[0] = 1;  // let go after a millisecond
  VectorXd frequency = VectorXd::Constant(4001, 5);
  frequency.tail(2001).setConstant(10);
  const VectorXd response = history::mode(time, input, frequency, 1e-3);
  const auto crossings = [&](int first, int last) {
    int count = 0;
    for (int row = first + 1; row <= last; ++row) {
      count += (response[row - 1] < 0) != (response[row] < 0) ? 1 : 0;
    }
    return count;
  };
  TEST_ASSERT_INT_WITHIN(1, 20, crossings(0, 2000));
  TEST_ASSERT_INT_WITHIN(1, 40, crossings(2000, 4000));
}

void a_lag_stays_behind_a_ramp_by_its_time_constant() {
  const VectorXd time = times(500, 0.004);
  const VectorXd output = history::lag(time, 2 * time, 0.03);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2 * time[400] - 0.06, output[400]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, -0.06, output[0]);
}

void a_lag_follows_a_sine_as_its_transfer_function_says() {
  constexpr double kLag = 0.03;
  constexpr double kOmega = 3;
  const VectorXd time = times(500, 0.02);
  const VectorXd output = history::lag(time, (kOmega * time).array().sin(), kLag);
  const double gain = 1 / std::hypot(1, kOmega * kLag);
  for (int row = 100; row < 400; ++row) {
    const double expected = gain * std::sin(kOmega * time[row] - std::atan(kOmega * kLag));
    TEST_ASSERT_DOUBLE_WITHIN(2e-6, expected, output[row]);
  }
}

void a_lag_without_a_constant_is_the_input() {
  const VectorXd input = triangle(1);
  TEST_ASSERT_TRUE(history::lag(times(401, 0.01), input, 0) == input);
}

void what_is_delayed_is_what_was_before_and_goes_on_at_the_ends() {
  const VectorXd time = times(100, 0.01);
  const Eigen::MatrixXd late = history::delayed(time, 5 * time, 0.025);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5 * (0.5 - 0.025), late(50, 0));
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5 * (0.01 - 0.025), late(1, 0));
  const Eigen::MatrixXd early = history::delayed(time, 5 * time, -0.025);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5 * (0.5 + 0.025), early(50, 0));
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5 * (0.99 + 0.025), early(99, 0));
}

void a_smooth_motion_is_delayed_without_cutting_its_corners() {
  VectorXd time = times(200, 0.02);
  for (Eigen::Index i = 1; i < time.size(); ++i) {
    time[i] += 0.004 * std::sin(37.0 * static_cast<double>(i));
  }
  const VectorXd position = (3 * time).array().sin();
  for (const double delay : {0.004, 0.01, 0.0337, -0.02}) {
    const Eigen::MatrixXd late = history::delayed_smoothly(time, position, delay);
    for (int row = 10; row < 190; ++row) {
      // A straight line would be off by (3 · 0.02)² / 8, which is 5e-4.
      TEST_ASSERT_DOUBLE_WITHIN(2e-5, std::sin(3 * (time[row] - delay)), late(row, 0));
    }
  }
  const Eigen::MatrixXd ramp = history::delayed_smoothly(time, 5 * time, 0.025);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5 * (time[0] - 0.025), ramp(0, 0));
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5 * (time[199] - 0.025), ramp(199, 0));
}

void a_motion_is_where_it_was_before() {
  const VectorXd time = times(201, 0.01);
  const VectorXd position = (3 * time).array().sin();
  const VectorXd velocity = 3 * (3 * time).array().cos();
  for (const double delay : {0.004, 0.01, 0.0337, -0.02}) {
    const VectorXd late = history::delayed_motion(time, position, velocity, delay);
    for (int row = 10; row < 190; ++row) {
      // Hermite's cubic is off by (3 h)⁴ / 384 at most.
      TEST_ASSERT_DOUBLE_WITHIN(1e-8, std::sin(3 * (time[row] - delay)), late[row]);
    }
    const double start = position[0] - delay * velocity[0];
    TEST_ASSERT_DOUBLE_WITHIN(delay > 0 ? 1e-12 : 1, start, late[0]);
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(play_follows_with_half_the_gap_on_either_side);
  RUN_TEST(a_motion_is_where_it_was_before);
  RUN_TEST(a_flank_changes_over_beyond_the_drag_only);
  RUN_TEST(bouc_wen_rises_to_one_as_an_exponential_and_does_not_depend_on_the_sampling);
  RUN_TEST(a_loop_of_bouc_wen_closes_on_itself);
  RUN_TEST(prandtl_ishlinskii_begins_as_a_spring_and_ends_saturated);
  RUN_TEST(the_yield_of_a_loop_is_by_how_much_it_is_complete_later_than_at_once);
  RUN_TEST(a_mode_rings_at_its_frequency_and_dies_out_at_its_damping);
  RUN_TEST(a_mode_does_not_depend_on_even_steps);
  RUN_TEST(a_mode_whose_frequency_doubles_rings_twice_as_fast_from_there_on);
  RUN_TEST(a_lag_stays_behind_a_ramp_by_its_time_constant);
  RUN_TEST(a_lag_follows_a_sine_as_its_transfer_function_says);
  RUN_TEST(a_lag_without_a_constant_is_the_input);
  RUN_TEST(a_smooth_motion_is_delayed_without_cutting_its_corners);
  RUN_TEST(what_is_delayed_is_what_was_before_and_goes_on_at_the_ends);
  return UNITY_END();
}
