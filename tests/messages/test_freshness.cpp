#include <initializer_list>

#include "messages/freshness.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

constexpr Freshness kNow = 179'000'000'000'000;  // some day in 2026
constexpr Freshness kLater = kNow + 3 * kFreshnessWindow;

void the_whole_value_is_the_closest_to_the_clock() {
  constexpr unsigned kBits = 20;
  constexpr Freshness kLow = (Freshness{1} << kBits) - 1;
  for (const Freshness clock : {kNow, (kNow | kLow), (kNow | kLow) + 1}) {
    for (const std::int64_t off : {-524'288, -25'000, -1, 0, 1, 25'000, 524'287}) {
      const Freshness value = clock + static_cast<Freshness>(off);
      TEST_ASSERT_EQUAL_UINT64(value, whole_freshness(value & kLow, kBits, clock));
    }
    const Freshness too_far = clock + 524'288;
    TEST_ASSERT_EQUAL_UINT64(clock - 524'288, whole_freshness(too_far & kLow, kBits, clock));
  }
}

void a_sender_never_repeats_a_value() {
  FreshnessSource source;
  TEST_ASSERT_EQUAL_UINT64(kNow, source.next(kNow));
  TEST_ASSERT_EQUAL_UINT64(kNow + 1, source.next(kNow));
  TEST_ASSERT_EQUAL_UINT64(kNow + 2, source.next(kNow - 1'000'000));  // the clock was set back
  TEST_ASSERT_EQUAL_UINT64(kLater, source.next(kLater));
}

void a_value_is_taken_once_and_nothing_before_it() {
  FreshnessGate gate(kNow);
  TEST_ASSERT_TRUE(gate.is_fresh(kLater, kLater));
  gate.close_up_to(kLater);
  TEST_ASSERT_FALSE(gate.is_fresh(kLater, kLater));
  TEST_ASSERT_FALSE(gate.is_fresh(kLater - 1, kLater));
  TEST_ASSERT_TRUE(gate.is_fresh(kLater + 1, kLater));
  gate.close_up_to(kLater - 1);
  TEST_ASSERT_FALSE(gate.is_fresh(kLater, kLater));
}

void only_values_near_the_clock_are_taken() {
  const FreshnessGate gate(kNow);
  TEST_ASSERT_TRUE(gate.is_fresh(kLater - kFreshnessWindow, kLater));
  TEST_ASSERT_FALSE(gate.is_fresh(kLater - kFreshnessWindow - 1, kLater));
  TEST_ASSERT_TRUE(gate.is_fresh(kLater + kFreshnessWindow, kLater));
  TEST_ASSERT_FALSE(gate.is_fresh(kLater + kFreshnessWindow + 1, kLater));
}

/// Whatever the clocks' difference that is borne.
void nothing_made_before_a_restart_is_taken_after_it() {
  const FreshnessGate gate(kNow);
  const Freshness latest_before = kNow + kFreshnessWindow;
  for (Freshness clock = kNow; clock <= kLater; clock += 100) {
    TEST_ASSERT_FALSE(gate.is_fresh(latest_before, clock));
  }
  TEST_ASSERT_TRUE(gate.is_fresh(latest_before + 1, latest_before + 1));
}

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr Freshness kUnitsASecond = 100'000;

/// A time of day and a monotonic clock that go on together.
struct Clocks {
  Freshness day = kNow;
  std::int64_t monotonic = 5 * kSecond;

  void pass(std::int64_t milliseconds) {
    day += static_cast<Freshness>(100 * milliseconds);
    monotonic += 1'000'000 * milliseconds;
  }
};

void a_clock_that_is_wrong_for_a_moment_is_not_followed() {
  for (const std::int64_t jump : {600, -600, 1, -1}) {  // s
    const auto units = static_cast<Freshness>(jump * 100'000);
    SteadyTime steady;
    Clocks clocks;
    for (int i = 0; i < 5000; ++i) {
      const bool is_wrong = i >= 1000 && i < 2000;
      clocks.pass(4);
      const Freshness shown = is_wrong ? clocks.day + units : clocks.day;
      TEST_ASSERT_EQUAL_UINT64(clocks.day, steady.at(shown, clocks.monotonic));
    }
  }
}

void a_clock_that_stays_where_it_was_set_is_followed_after_ten_seconds() {
  SteadyTime steady;
  Clocks clocks;
  steady.at(clocks.day, clocks.monotonic);
  const Freshness jump = 600 * kUnitsASecond;
  clocks.pass(4);
  TEST_ASSERT_EQUAL_UINT64(clocks.day, steady.at(clocks.day + jump, clocks.monotonic));
  clocks.pass(9'900);
  TEST_ASSERT_EQUAL_UINT64(clocks.day, steady.at(clocks.day + jump, clocks.monotonic));
  clocks.pass(100);
  TEST_ASSERT_EQUAL_UINT64(clocks.day + jump, steady.at(clocks.day + jump, clocks.monotonic));
}

void a_clock_that_is_slewed_is_followed_at_once() {
  SteadyTime steady;
  Clocks clocks;
  steady.at(clocks.day, clocks.monotonic);
  Freshness slewed = 0;
  for (int i = 0; i < 10'000; ++i) {
    clocks.pass(4);
    slewed += i % 5 == 0 ? 1 : 0;  // 500 ppm
    TEST_ASSERT_EQUAL_UINT64(clocks.day + slewed, steady.at(clocks.day + slewed, clocks.monotonic));
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(the_whole_value_is_the_closest_to_the_clock);
  RUN_TEST(a_sender_never_repeats_a_value);
  RUN_TEST(a_value_is_taken_once_and_nothing_before_it);
  RUN_TEST(only_values_near_the_clock_are_taken);
  RUN_TEST(nothing_made_before_a_restart_is_taken_after_it);
  RUN_TEST(a_clock_that_is_wrong_for_a_moment_is_not_followed);
  RUN_TEST(a_clock_that_stays_where_it_was_set_is_followed_after_ten_seconds);
  RUN_TEST(a_clock_that_is_slewed_is_followed_at_once);
  return UNITY_END();
}
