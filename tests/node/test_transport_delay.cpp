// How old messages are that carry their sender's clock, and clocks that jump.
#include <random>

#include "messages/messages.hpp"
#include "messages/microseconds.hpp"
#include "node/transport_delay.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kPeriod = 4 * kMillisecond;

/// A stream of messages by a clock that is not ours.
class Stream {
 public:
  /// Delay of the next message, ns, if it was `late` on its way and its clock is `ahead`.
  std::int64_t next(std::int64_t late = 0, std::int64_t ahead = 0) {
    now_ += kPeriod;
    return delay_.observe(now_ - clock_ - late + ahead, now_);
  }

  /// Delay of the last of as many messages as a time has.
  std::int64_t pass(std::int64_t time, std::int64_t late = 0) {
    std::int64_t last = 0;
    for (std::int64_t passed = 0; passed < time; passed += kPeriod) {
      last = next(late);
    }
    return last;
  }

  /// The sender's clock shows so much less from now on.
  void put_back(std::int64_t time) { clock_ += time; }

 private:
  TransportDelay delay_;
  std::int64_t now_ = 10 * kSecond;
  std::int64_t clock_ = 3 * kSecond;
};

void a_message_is_as_old_as_it_was_longer_on_its_way_than_usual() {
  Stream stream;
  stream.pass(kSecond);
  TEST_ASSERT_INT64_WITHIN(kMillisecond / 5, 7 * kMillisecond, stream.next(7 * kMillisecond));
  TEST_ASSERT_INT64_WITHIN(kMillisecond / 5, 70 * kMillisecond, stream.next(70 * kMillisecond));
  TEST_ASSERT_INT64_WITHIN(kMillisecond / 5, 0, stream.next());
}

void without_a_time_a_message_is_new() {
  TransportDelay delay;
  TEST_ASSERT_EQUAL_INT64(0, delay.observe(kNoTime, kSecond));
}

void one_message_of_a_wrong_clock_moves_nothing() {
  for (const std::int64_t ahead : {5 * kSecond, -5 * kSecond, 2000 * kSecond, 20 * kMillisecond}) {
    Stream stream;
    stream.pass(kSecond);
    stream.next(0, ahead);
    TEST_ASSERT_INT64_WITHIN(kMillisecond / 5, 0, stream.next());
    stream.next(0, ahead);
    TEST_ASSERT_INT64_WITHIN(kMillisecond / 5, 0, stream.next());
  }
}

void every_third_message_of_a_wrong_clock_moves_nothing() {
  Stream stream;
  stream.pass(kSecond);
  for (int i = 0; i < 3000; ++i) {
    const std::int64_t delay = stream.next(0, i % 3 == 0 ? 5 * kSecond : 0);
    TEST_ASSERT_INT64_WITHIN(kMillisecond / 2, 0, delay);
  }
}

void a_clock_that_is_put_forward_is_followed_at_once() {
  Stream stream;
  stream.pass(kSecond);
  stream.put_back(-20 * kSecond);
  for (int i = 0; i < 4; ++i) {
    TEST_ASSERT_EQUAL_INT64(0, stream.next());
  }
  TEST_ASSERT_INT64_WITHIN(kMillisecond / 5, 30 * kMillisecond, stream.next(30 * kMillisecond));
}

void a_clock_that_begins_anew_is_followed_after_a_second() {
  for (const std::int64_t back : {kSecond / 5, 7 * kSecond, 3000 * kSecond}) {
    Stream stream;
    stream.pass(kSecond);
    stream.put_back(back);
    stream.pass(kSecond + 2 * kPeriod);
    TEST_ASSERT_INT64_WITHIN(kMillisecond / 2, 0, stream.next());
    TEST_ASSERT_INT64_WITHIN(kMillisecond / 2, 30 * kMillisecond, stream.next(30 * kMillisecond));
  }
}

void a_stream_that_is_held_up_is_old_for_a_second() {
  Stream stream;
  stream.pass(kSecond);
  for (std::int64_t passed = 0; passed < kSecond - 2 * kPeriod; passed += kPeriod) {
    TEST_ASSERT_INT64_WITHIN(kMillisecond / 2, 100 * kMillisecond, stream.next(100 * kMillisecond));
  }
}

void a_stream_that_comes_ever_later_is_old_for_good() {
  Stream stream;
  stream.pass(kSecond);
  std::int64_t late = 0;
  for (int i = 0; i < 1000; ++i) {
    late += kMillisecond;
    TEST_ASSERT_INT64_WITHIN(kMillisecond, late, stream.next(late));
  }
}

void clocks_that_drift_apart_are_followed() {
  for (const int ppm : {100, -100}) {
    TransportDelay delay;
    for (std::int64_t i = 0; i < 250'000; ++i) {  // 1000 s
      const std::int64_t now = kSecond + i * kPeriod;
      const std::int64_t sent = 5 * kSecond + i * (kPeriod + kPeriod * ppm / 1'000'000);
      TEST_ASSERT_INT64_WITHIN(kMillisecond, 0, delay.observe(sent, now));
    }
  }
}

void clocks_may_wrap() {
  constexpr std::int64_t kWrap = (std::int64_t{1} << 32) * 1000;  // ns
  TransportDelay delay;
  for (std::int64_t i = -1000; i < 1000; ++i) {
    const std::int64_t now = kWrap + i * kPeriod;
    const std::int64_t late = i % 10 == 5 ? 5 * kMillisecond : 0;
    const std::int64_t sent = (now - late + kWrap / 2) % kWrap;
    TEST_ASSERT_INT64_WITHIN(kMillisecond / 2, late, delay.observe(sent, now));
  }
}

void microseconds_are_those_of_a_division() {
  std::mt19937_64 random(1);
  for (int i = 0; i < 1'000'000; ++i) {
    // They are of every size, and about the ends of the digits.
    const auto any = static_cast<std::int64_t>(random()) >> (random() % 64);
    const std::int64_t near = (std::int64_t{1} << (random() % 63)) + i % 3 - 1;
    for (const std::int64_t time : {any, near, -near, 1000 * (any / 1000)}) {
      TEST_ASSERT_EQUAL_UINT32(static_cast<std::uint32_t>(time / 1000), low_microseconds(time));
    }
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(microseconds_are_those_of_a_division);
  RUN_TEST(a_message_is_as_old_as_it_was_longer_on_its_way_than_usual);
  RUN_TEST(without_a_time_a_message_is_new);
  RUN_TEST(one_message_of_a_wrong_clock_moves_nothing);
  RUN_TEST(every_third_message_of_a_wrong_clock_moves_nothing);
  RUN_TEST(a_clock_that_is_put_forward_is_followed_at_once);
  RUN_TEST(a_clock_that_begins_anew_is_followed_after_a_second);
  RUN_TEST(a_stream_that_is_held_up_is_old_for_a_second);
  RUN_TEST(a_stream_that_comes_ever_later_is_old_for_good);
  RUN_TEST(clocks_that_drift_apart_are_followed);
  RUN_TEST(clocks_may_wrap);
  return UNITY_END();
}
