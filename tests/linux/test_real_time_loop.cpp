#include <poll.h>

#include <functional>
#include <thread>

#include "core/crc32.hpp"
#include "linux/clock.hpp"
#include "linux/real_time_loop.hpp"
#include "node/default_config.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

/// The loop in its thread, with LCM's queues for a bus; the test is the thread that serves it.
class Running {
 public:
  Running() {
    options_.lcm = "the test";
    options_.settings.node = default_node_config();
    options_.settings.trigger = Trigger::clock;
    node_->use_memory({slots_[0].data(), slots_[0].size()}, {slots_[1].data(), slots_[1].size()});
    TEST_ASSERT_EQUAL(Result::ok, node_->configure(options_.settings.node));
    loop_ = std::make_unique<RealTimeLoop>(options_, node_.get(), &can_, nullptr, nullptr, nullptr,
                                           exchange.get());
    thread_ = std::thread([this] { loop_->run(); });
  }
  ~Running() {
    exchange->stop();
    thread_.join();
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void send_table() {
    const std::array<std::uint32_t, 2> words = {1, 2};
    const std::uint32_t crc = crc32(words.data(), sizeof words);
    send(TransferBeginMessage{sizeof words, crc});
    send(TransferDataMessage{0, 2, {1, 2}});
    send(TransferEndMessage{crc});
  }

  /// The next message to the thread that serves, of a kind; null if none comes in `seconds`.
  template <typename Kind>
  std::optional<Kind> next(double seconds) {
    return find<Kind>(&exchange->from_real_time, seconds);
  }
  template <typename Kind>
  std::optional<Kind> next_on_the_bus(double seconds) {
    return find<Kind>(&exchange->lcm_to_send, seconds);
  }

  std::unique_ptr<Exchange> exchange = std::make_unique<Exchange>();

 private:
  void send(const Message& message) { exchange->lcm_received.send({message, sequence_++}); }

  template <typename Kind, typename Item>
  static std::optional<Kind> find(Channel<Item>* channel, double seconds) {
    const std::int64_t until = monotonic_now() + static_cast<std::int64_t>(1e9 * seconds);
    Item item;
    for (std::int64_t left = 1; left > 0; left = until - monotonic_now()) {
      pollfd input = {channel->number(), POLLIN, 0};
      poll(&input, 1, static_cast<int>(left / 1'000'000) + 1);
      channel->clear();
      while (channel->receive(&item)) {
        if (const auto* found = std::get_if<Kind>(&item)) {
          channel->wake();  // there may be more
          return *found;
        }
      }
    }
    return std::nullopt;
  }

  Options options_;
  std::unique_ptr<Node> node_ = std::make_unique<Node>();
  std::array<std::array<std::uint32_t, 64>, 2> slots_{};
  CanSocket can_;
  std::unique_ptr<RealTimeLoop> loop_;
  std::uint32_t sequence_ = 0;
  std::thread thread_;
};

std::uint8_t number(Reply reply) { return static_cast<std::uint8_t>(reply); }

/// The reply to the end of a transfer, those to its begin left out.
std::optional<std::uint8_t> answer(Running* running, double seconds) {
  while (const auto reply = running->next_on_the_bus<TransferReplyMessage>(seconds)) {
    if (reply->stage == TransferStage::end) {
      return reply->result;
    }
  }
  return std::nullopt;
}

void a_table_that_nobody_checks_is_given_up_and_the_next_one_taken() {
  Running running;
  running.send_table();
  const auto first = running.next<TableReceived>(2);
  TEST_ASSERT_TRUE(first.has_value());
  TEST_ASSERT_EQUAL(number(Reply::transfer_not_checked), answer(&running, 4).value_or(0));

  running.send_table();
  const auto second = running.next<TableReceived>(2);
  TEST_ASSERT_TRUE(second.has_value());
  // The verdict on the first comes after all, and is not taken for one on the second.
  running.exchange->to_real_time.send(
      Verdict{first->transfer, Reply::ok, Result::table_version, {}});
  running.exchange->to_real_time.send(
      Verdict{second->transfer, Reply::ok, Result::table_corrupt, {}});
  TEST_ASSERT_EQUAL(static_cast<int>(Result::table_corrupt), answer(&running, 2).value_or(0));
}

void a_table_that_is_refused_unopened_is_answered_with_the_reason() {
  Running running;
  running.send_table();
  const auto received = running.next<TableReceived>(2);
  TEST_ASSERT_TRUE(received.has_value());
  running.exchange->to_real_time.send(
      Verdict{received->transfer, Reply::table_older, Result::no_table, {}});
  TEST_ASSERT_EQUAL(number(Reply::table_older), answer(&running, 2).value_or(0));
}

void a_table_is_handed_over_as_soon_as_there_is_room() {
  Running running;
  while (running.exchange->from_real_time.send(ConfigResult{})) {
  }
  running.send_table();
  TEST_ASSERT_FALSE(answer(&running, 0.1).has_value());
  TEST_ASSERT_TRUE(running.next<TableReceived>(2).has_value());
}

void a_stop_and_the_end_are_told_when_all_queues_are_full() {
  Running running;
  while (running.exchange->from_real_time.send(ConfigResult{})) {
  }
  running.exchange->stop();
  const std::int64_t until = monotonic_now() + 2'000'000'000;
  while (!running.exchange->has_ended() && monotonic_now() < until) {
    std::this_thread::yield();
  }
  TEST_ASSERT_TRUE(running.exchange->has_ended());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_table_that_nobody_checks_is_given_up_and_the_next_one_taken);
  RUN_TEST(a_table_that_is_refused_unopened_is_answered_with_the_reason);
  RUN_TEST(a_table_is_handed_over_as_soon_as_there_is_room);
  RUN_TEST(a_stop_and_the_end_are_told_when_all_queues_are_full);
  return UNITY_END();
}
