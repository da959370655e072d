#include "rsi/session.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using Verdict = RsiSession::Verdict;

namespace {

constexpr RsiPeer kController = 1;
constexpr RsiPeer kOther = 2;
constexpr std::int64_t kMillisecond = 1'000'000;

/// A session and a clock. Time passes before each telegram.
class Bench {
 public:
  Verdict telegram(std::uint64_t ipoc, int milliseconds = 4, RsiPeer peer = kController,
                   std::uint64_t late = 0, std::uint32_t digest = 0) {
    now_ += milliseconds * kMillisecond;
    return session.judge(peer, ipoc, late, digest != 0 ? digest : static_cast<std::uint32_t>(ipoc),
                         now_);
  }
  void run(std::uint64_t first, std::uint64_t step, int count) {
    for (int i = 0; i < count; ++i) {
      telegram(first + static_cast<std::uint64_t>(i) * step);
    }
  }

  RsiSession session{3};

 private:
  std::int64_t now_ = 1'000'000'000;
};

void telegrams_in_order_are_used_whatever_ipoc_counts_in() {
  for (const std::uint64_t step : {1U, 4U, 12U}) {
    Bench bench;
    TEST_ASSERT_EQUAL(Verdict::begun, bench.telegram(1000));
    for (std::uint64_t i = 1; i < 100; ++i) {
      TEST_ASSERT_EQUAL(Verdict::next, bench.telegram(1000 + i * step));
      TEST_ASSERT_TRUE(bench.session.missed() == 0);
    }
    TEST_ASSERT_EQUAL(100, bench.session.counters.received);
    TEST_ASSERT_EQUAL(0, bench.session.counters.lost);
  }
}

void a_few_lost_telegrams_are_borne_and_counted() {
  Bench bench;
  bench.run(1000, 4, 10);
  TEST_ASSERT_EQUAL(Verdict::next, bench.telegram(1036 + 4 * 4));
  TEST_ASSERT_TRUE(bench.session.missed() == 3);
  TEST_ASSERT_EQUAL(3, bench.session.counters.lost);
}

void a_jump_ahead_is_refused_until_there_was_a_pause() {
  Bench bench;
  bench.run(1000, 4, 10);
  TEST_ASSERT_EQUAL(Verdict::refused, bench.telegram(1036 + 5 * 4));
  TEST_ASSERT_EQUAL(1, bench.session.counters.out_of_sequence);
  TEST_ASSERT_EQUAL(Verdict::next, bench.telegram(1036 + 20 * 4, 60));
  TEST_ASSERT_TRUE(bench.session.missed() == 19);
}

void an_ipoc_between_two_cycles_is_refused() {
  Bench bench;
  bench.run(1000, 4, 10);
  TEST_ASSERT_EQUAL(Verdict::refused, bench.telegram(1036 + 6));
  TEST_ASSERT_EQUAL(Verdict::refused, bench.telegram(1036 + 3));
}

void a_telegram_that_comes_late_is_refused() {
  Bench bench;
  bench.run(1000, 4, 10);
  TEST_ASSERT_EQUAL(Verdict::refused, bench.telegram(1032));
  TEST_ASSERT_EQUAL(1, bench.session.counters.old);
  TEST_ASSERT_EQUAL(Verdict::next, bench.telegram(1040));
}

void the_step_is_found_although_telegrams_are_lost_at_the_start() {
  Bench bench;
  bench.telegram(1000);
  bench.telegram(1012);
  TEST_ASSERT_EQUAL(Verdict::next, bench.telegram(1016));
  TEST_ASSERT_EQUAL(Verdict::next, bench.telegram(1020));
}

void the_same_telegram_again_is_a_repetition() {
  Bench bench;
  bench.run(1000, 4, 10);
  TEST_ASSERT_EQUAL(Verdict::repeated, bench.telegram(1036));
  TEST_ASSERT_EQUAL(1, bench.session.counters.repeated);
  TEST_ASSERT_FALSE(bench.session.has_conflict());
}

void other_content_under_the_same_ipoc_proves_a_second_controller() {
  Bench bench;
  for (std::uint64_t i = 0; i < 20; ++i) {
    bench.telegram(1000 + 4 * i);
    TEST_ASSERT_EQUAL(Verdict::refused, bench.telegram(1000 + 4 * i, 0, kController, 0, 99));
  }
  TEST_ASSERT_TRUE(bench.session.has_conflict());
  bench.session.clear_conflict();
  TEST_ASSERT_FALSE(bench.session.has_conflict());
}

void telegrams_of_another_sender_are_refused_and_prove_a_second_controller() {
  Bench bench;
  for (std::uint64_t i = 0; i < 20; ++i) {
    bench.telegram(1000 + 4 * i);
    TEST_ASSERT_EQUAL(Verdict::refused, bench.telegram(5000 + 4 * i, 0, kOther));
  }
  TEST_ASSERT_TRUE(bench.session.has_conflict());
  TEST_ASSERT_EQUAL(20, bench.session.counters.contradicting);
}

void another_sender_may_take_over_after_a_pause() {
  Bench bench;
  bench.run(1000, 4, 10);
  TEST_ASSERT_EQUAL(Verdict::begun, bench.telegram(77, 51, kOther));
  TEST_ASSERT_EQUAL(2, bench.session.sessions());
}

void a_session_begins_where_the_controller_was_started_again() {
  Bench backwards;
  backwards.run(1000, 4, 10);
  TEST_ASSERT_EQUAL(Verdict::begun, backwards.telegram(4, 100));
  Bench silent;
  silent.run(1000, 4, 10);
  TEST_ASSERT_EQUAL(Verdict::begun, silent.telegram(1036 + 600, 600));
  Bench counted;
  counted.telegram(1000, 4, kController, 5);
  counted.telegram(1004, 4, kController, 6);
  TEST_ASSERT_EQUAL(Verdict::begun, counted.telegram(1008, 4, kController, 0));
}

void late_answers_are_told_as_the_controller_counts_them() {
  Bench bench;
  bench.telegram(1000, 4, kController, 7);
  TEST_ASSERT_TRUE(bench.session.newly_late() == 0);
  bench.telegram(1004, 4, kController, 9);
  TEST_ASSERT_TRUE(bench.session.newly_late() == 2);
}

void a_stranger_cannot_end_a_session_by_an_ipoc_far_off() {
  Bench bench;
  bench.run(1000, 4, 10);
  bench.telegram(~std::uint64_t{0});
  bench.telegram(0);
  TEST_ASSERT_EQUAL(Verdict::next, bench.telegram(1040));
  TEST_ASSERT_EQUAL(1, bench.session.sessions());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(telegrams_in_order_are_used_whatever_ipoc_counts_in);
  RUN_TEST(a_few_lost_telegrams_are_borne_and_counted);
  RUN_TEST(a_jump_ahead_is_refused_until_there_was_a_pause);
  RUN_TEST(an_ipoc_between_two_cycles_is_refused);
  RUN_TEST(a_telegram_that_comes_late_is_refused);
  RUN_TEST(the_step_is_found_although_telegrams_are_lost_at_the_start);
  RUN_TEST(the_same_telegram_again_is_a_repetition);
  RUN_TEST(other_content_under_the_same_ipoc_proves_a_second_controller);
  RUN_TEST(telegrams_of_another_sender_are_refused_and_prove_a_second_controller);
  RUN_TEST(another_sender_may_take_over_after_a_pause);
  RUN_TEST(a_session_begins_where_the_controller_was_started_again);
  RUN_TEST(late_answers_are_told_as_the_controller_counts_them);
  RUN_TEST(a_stranger_cannot_end_a_session_by_an_ipoc_far_off);
  return UNITY_END();
}
