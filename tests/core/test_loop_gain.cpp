// The largest safe gain against closed forms, and against the loop run step by step.
#include <cmath>
#include <random>
#include <vector>

#include "flexcomp/loop_gain.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

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
  for (int i = 0; i < (FLEXCOMP_FEW_CASES ? 20 : 200); ++i) {
    const CorrectionLoop loop = {0.004, uniform(random) < 0.3 ? 0 : 1 + 60 * uniform(random),
                                 0.004 * (1 + static_cast<int>(5 * uniform(random)))};
    const double factor = (0.1 + 5 * uniform(random)) * (uniform(random) < 0.5 ? -1 : 1);
    const double critical = critical_gain(factor, loop);
    TEST_ASSERT_TRUE(growth(0.99 * critical, factor, loop) < 1e-3);
    TEST_ASSERT_TRUE(growth(1.01 * critical, factor, loop) > 1e3);
  }
}

/// The least and the largest feedback the same.
GainLimit limit_of(double feedback, const CorrectionLoop& loop) {
  FeedbackRange range;
  range.include(feedback);
  return gain_limit(range, loop);
}

void a_tool_pushed_out_of_the_cut_may_be_corrected_in_full() {
  // L is −g/3: the correction meets a force that weakens as the tool gives way.
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 3, limit_of(-0.5, {0.004, 0, 0.004}).stable);
  TEST_ASSERT_EQUAL_DOUBLE(1, limit_of(-0.5, {0.004, 0, 0.004}).safe);
}

void a_tool_pulled_into_the_cut_is_limited_by_the_closed_form() {
  // Without a filter L is g λ/(1−λ), which may be one; half of that with the margin.
  for (const double feedback : {0.3, 0.4, 0.6}) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, std::fmin(1.0, (1 - feedback) / feedback / 2),
                              limit_of(feedback, {0.004, 0, 0.004}).safe);
  }
}

void where_no_stable_gain_keeps_the_cut_shallow_none_is_safe() {
  // 2/(3 (1 − λ)) times as deep with half of the stable gain: twice at λ = 2/3.
  TEST_ASSERT_FALSE(limit_of(0.66, {0.004, 0, 0.004}).digs_in());
  TEST_ASSERT_TRUE(limit_of(0.67, {0.004, 0, 0.004}).digs_in());
  TEST_ASSERT_EQUAL_DOUBLE(GainLimit::kNone, limit_of(0.67, {0.004, 0, 0.004}).safe);
}

void a_process_that_digs_in_by_itself_allows_no_correction() {
  for (const double feedback : {1.0, 1.7}) {
    TEST_ASSERT_EQUAL_DOUBLE(0, limit_of(feedback, {0.004, 20, 0.004}).stable);
    TEST_ASSERT_EQUAL_DOUBLE(GainLimit::kNone, limit_of(feedback, {0.004, 20, 0.004}).safe);
  }
}

void no_feedback_allows_every_gain() {
  TEST_ASSERT_EQUAL_DOUBLE(1, limit_of(0, {0.004, 20, 0.004}).safe);
}

void a_gain_follows_from_its_own_process_only() {
  const GainBasis basis{-0.0002F, 0.0012F, 0.002F, 0.004F, 60, 0.004F};
  const double safe = gain_limit(basis).safe;
  TEST_ASSERT_TRUE(safe > 0.1 && safe < 1);
  TEST_ASSERT_TRUE(follows_from(safe, basis));
  for (const double other : {0.0, -safe, 1.001 * safe, 0.999 * safe, 1000.0, std::nan("")}) {
    TEST_ASSERT_FALSE(follows_from(other, basis));
  }
  for (float GainBasis::*const number : {&GainBasis::most_push, &GainBasis::depth_of_cut,
                                         &GainBasis::period, &GainBasis::filter_cutoff}) {
    GainBasis altered = basis;
    altered.*number *= 1.1F;
    TEST_ASSERT_FALSE(follows_from(safe, altered));
  }
  TEST_ASSERT_TRUE(follows_from(0.7, GainBasis{}));
}

void a_process_that_cannot_be_allows_no_gain() {
  const GainBasis basis{-0.0002F, 0.0012F, 0.002F, 0.004F, 60, 0.004F};
  for (float GainBasis::*const number :
       {&GainBasis::least_push, &GainBasis::most_push, &GainBasis::depth_of_cut, &GainBasis::period,
        &GainBasis::filter_cutoff, &GainBasis::delay}) {
    GainBasis altered = basis;
    altered.*number *= -1;
    TEST_ASSERT_FALSE(follows_from(gain_limit(basis).safe, altered));
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(with_delay_alone_the_limit_is_a_loop_of_one);
  RUN_TEST(below_the_critical_gain_the_loop_dies_out_and_above_it_grows);
  RUN_TEST(a_tool_pushed_out_of_the_cut_may_be_corrected_in_full);
  RUN_TEST(a_tool_pulled_into_the_cut_is_limited_by_the_closed_form);
  RUN_TEST(where_no_stable_gain_keeps_the_cut_shallow_none_is_safe);
  RUN_TEST(a_process_that_digs_in_by_itself_allows_no_correction);
  RUN_TEST(no_feedback_allows_every_gain);
  RUN_TEST(a_gain_follows_from_its_own_process_only);
  RUN_TEST(a_process_that_cannot_be_allows_no_gain);
  return UNITY_END();
}
