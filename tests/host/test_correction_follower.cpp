#include <algorithm>
#include <cmath>

#include "client/correction_follower.hpp"
#include "unity_main.hpp"

using flexcomp::CorrectionFollower;
using Correction = CorrectionFollower::Correction;

namespace {

constexpr double kPeriod = 0.004;

Correction of(double value) { return Correction::Constant(value); }

/// Follows a node that corrects by `value` for some periods.
CorrectionFollower following(double value) {
  CorrectionFollower follower(kPeriod, 0.05, 0.5);
  for (int i = 0; i < 10; ++i) {
    follower.take(of(value), false);
    follower.end_period();
  }
  return follower;
}

void it_moves_by_what_comes() {
  CorrectionFollower follower = following(0.001);
  TEST_ASSERT_EQUAL_DOUBLE(0.001, follower.correction()[3]);
  follower.take(of(0.0011), false);
  follower.end_period();
  TEST_ASSERT_EQUAL_DOUBLE(0.0011, follower.correction()[3]);
}

void without_answers_it_holds_then_fades_without_a_jump() {
  CorrectionFollower follower = following(0.001);
  double last = 0.001;
  for (int i = 1; i <= 200; ++i) {
    follower.end_period();
    const double now = follower.correction()[0];
    const double time = i * kPeriod;
    const double expected = time <= 0.05 ? 0.001 : 0.001 * std::max(0.0, 1 - (time - 0.05) / 0.5);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, expected, now);
    TEST_ASSERT_DOUBLE_WITHIN(0.001 * kPeriod / 0.5 + 1e-12, last, now);
    last = now;
  }
  TEST_ASSERT_EQUAL_DOUBLE(0, last);
}

void a_short_gap_is_bridged() {
  CorrectionFollower follower = following(0.001);
  for (int i = 0; i < 12; ++i) {
    follower.end_period();
  }
  follower.take(of(0.00101), false);
  follower.end_period();
  TEST_ASSERT_EQUAL_DOUBLE(0.00101, follower.correction()[0]);
}

void a_node_that_is_suddenly_off_has_been_started_anew_and_is_faded_out() {
  CorrectionFollower follower = following(0.001);
  double last = 0.001;
  for (int i = 0; i < 200; ++i) {
    follower.take(of(0), true);
    follower.end_period();
    TEST_ASSERT_DOUBLE_WITHIN(0.001 * kPeriod / 0.5 + 1e-12, last, follower.correction()[0]);
    last = follower.correction()[0];
  }
  TEST_ASSERT_EQUAL_DOUBLE(0, last);
}

void once_lost_it_stays_at_zero_until_the_node_has_been_off() {
  CorrectionFollower follower = following(0.001);
  for (int i = 0; i < 200; ++i) {
    follower.end_period();
  }
  for (int i = 0; i < 50; ++i) {
    follower.take(of(0.001), false);
    follower.end_period();
    TEST_ASSERT_EQUAL_DOUBLE(0, follower.correction()[0]);
  }
  follower.take(of(0), true);
  follower.end_period();
  follower.take(of(1e-5), false);
  follower.end_period();
  TEST_ASSERT_EQUAL_DOUBLE(1e-5, follower.correction()[0]);
}

void what_is_not_finite_is_no_answer() {
  CorrectionFollower follower = following(0.001);
  for (int i = 0; i < 200; ++i) {
    follower.take(of(std::nan("")), false);
    follower.end_period();
    TEST_ASSERT_TRUE(follower.correction().allFinite());
  }
  TEST_ASSERT_EQUAL_DOUBLE(0, follower.correction()[0]);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(it_moves_by_what_comes);
  RUN_TEST(without_answers_it_holds_then_fades_without_a_jump);
  RUN_TEST(a_short_gap_is_bridged);
  RUN_TEST(a_node_that_is_suddenly_off_has_been_started_anew_and_is_faded_out);
  RUN_TEST(once_lost_it_stays_at_zero_until_the_node_has_been_off);
  RUN_TEST(what_is_not_finite_is_no_answer);
  return UNITY_END();
}
