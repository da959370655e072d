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

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(the_whole_value_is_the_closest_to_the_clock);
  RUN_TEST(a_sender_never_repeats_a_value);
  RUN_TEST(a_value_is_taken_once_and_nothing_before_it);
  RUN_TEST(only_values_near_the_clock_are_taken);
  RUN_TEST(nothing_made_before_a_restart_is_taken_after_it);
  return UNITY_END();
}
