// The largest safe gain against closed forms, and against the loop run step by step.
#include <cmath>
#include <random>
#include <vector>

#include "control/loop_gain.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using namespace flexcomp::control;

namespace {

constexpr double kPi = 3.14159265358979323846;

/// The closed loop y = −g·factor·H y after a push of one at the beginning: how large it is at last.
double growth(double gain, double factor, const CorrectionLoop& loop) {
  constexpr int kSteps = 40000;
  const auto ticks = static_cast<std::size_t>(std::lround(loop.delay / loop.period));
  const double share =
      loop.filter_cutoff > 0 ? -std::expm1(-2 * kPi * loop.filter_cutoff * loop.period) : 1.0;
  std::vector<double> filtered(kSteps + ticks, 0.0);
  double largest = 0;  // in the last thousandth
  for (int i = 0; i < kSteps; ++i) {
    const auto now = static_cast<std::size_t>(i) + ticks;
    const double push = i == 0 ? 1 : 0;
    const double y = push - gain * factor * filtered[now - ticks];
    const double before = now > 0 ? filtered[now - 1] : 0;
    filtered[now] = before + share * (y - before);
    if (!(std::fabs(y) < 1e100)) {
      return 1e100;
    }
    largest = i >= kSteps - kSteps / 1000 ? std::fmax(largest, std::fabs(y)) : 0;
  }
  return largest;
}

void with_delay_alone_the_limit_is_a_loop_of_one() {
  for (const double delay : {0.004, 0.008, 0.02}) {
    for (const double factor : {0.3, 2.0, -0.7, -3.0}) {
      TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1 / std::fabs(factor),
                                critical_gain(factor, {0.004, 0, delay}));
    }
  }
}

void below_the_critical_gain_the_loop_dies_out_and_above_it_grows() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 200; ++i) {
    const CorrectionLoop loop = {0.004, uniform(random) < 0.3 ? 0 : 1 + 60 * uniform(random),
                                 0.004 * (1 + static_cast<int>(5 * uniform(random)))};
    const double factor = (0.1 + 5 * uniform(random)) * (uniform(random) < 0.5 ? -1 : 1);
    const double critical = critical_gain(factor, loop);
    TEST_ASSERT_TRUE(growth(0.99 * critical, factor, loop) < 1e-3);
    TEST_ASSERT_TRUE(growth(1.01 * critical, factor, loop) > 1e3);
  }
}

void a_tool_pushed_out_of_the_cut_may_be_corrected_in_full() {
  const Compliance<double> compliance = Compliance<double>::Identity() * 1e-6;
  Wrench<double> wrench;
  wrench << 1000, 0, 0, 0, 0, 0;
  // The force pushes away from the material, and weakens as the tool gives way.
  const double feedback = cut_feedback(compliance, wrench, {-1, 0, 0}, 0.002);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, -0.5, feedback);
  TEST_ASSERT_EQUAL_DOUBLE(1, largest_safe_gain(feedback, {0.004, 0, 0.004}, 1));
}

void a_tool_pulled_into_the_cut_is_limited_by_the_closed_form() {
  // Without a filter L is g λ/(1−λ), which may be one; half of that with the margin.
  for (const double feedback : {0.4, 0.6, 0.8, 0.95}) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, std::fmin(1.0, (1 - feedback) / feedback / 2),
                              largest_safe_gain(feedback, {0.004, 0, 0.004}));
  }
}

void a_process_that_digs_in_by_itself_allows_no_correction() {
  TEST_ASSERT_EQUAL_DOUBLE(0, largest_safe_gain(1.0, {0.004, 20, 0.004}));
  TEST_ASSERT_EQUAL_DOUBLE(0, largest_safe_gain(1.7, {0.004, 20, 0.004}));
}

void no_feedback_allows_every_gain() {
  TEST_ASSERT_EQUAL_DOUBLE(1, largest_safe_gain(0, {0.004, 20, 0.004}));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(with_delay_alone_the_limit_is_a_loop_of_one);
  RUN_TEST(below_the_critical_gain_the_loop_dies_out_and_above_it_grows);
  RUN_TEST(a_tool_pushed_out_of_the_cut_may_be_corrected_in_full);
  RUN_TEST(a_tool_pulled_into_the_cut_is_limited_by_the_closed_form);
  RUN_TEST(a_process_that_digs_in_by_itself_allows_no_correction);
  RUN_TEST(no_feedback_allows_every_gain);
  return UNITY_END();
}
