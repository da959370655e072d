// Sets of frames and streams of messages: what is lost, repeated, late or of two senders.
#include <vector>

#include "messages/can_decoder.hpp"
#include "messages/can_encoder.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

constexpr std::int64_t kTick = 4'000'000;  // ns

/// A sender of wrenches (sets of two frames), numbered by their force.
class Sender {
 public:
  std::vector<CanFrame> next(double force) {
    const FrameList list = encoder_.encode(WrenchMessage{kNoTime, {force, 0, 0, 0, 0, 0}, false});
    return {list.frames.begin(), list.frames.begin() + static_cast<std::ptrdiff_t>(list.count)};
  }

 private:
  CanEncoder encoder_;
};

class Receiver {
 public:
  /// Force of the wrench that the frame completes, or -1.
  double take(const CanFrame& frame) {
    const Message message = decoder_.decode(frame, now_);
    const auto* wrench = std::get_if<WrenchMessage>(&message);
    return wrench == nullptr ? -1 : wrench->wrench[0];
  }

  double take(const std::vector<CanFrame>& frames) {
    double force = -1;
    for (const CanFrame& frame : frames) {
      force = take(frame);
    }
    now_ += kTick;
    return force;
  }

  void wait(std::int64_t time) { now_ += time; }
  SequenceMonitor& stream() { return decoder_.monitor(kClassicGroup<WrenchMessage>); }
  const StreamCounters& counters() { return stream().counters; }

 private:
  CanDecoder decoder_;
  std::int64_t now_ = 0;
};

void a_set_is_used_only_when_all_of_it_is_there() {
  Sender sender;
  Receiver receiver;
  const auto frames = sender.next(1);
  TEST_ASSERT_EQUAL_DOUBLE(-1, receiver.take(frames[0]));
  TEST_ASSERT_EQUAL_DOUBLE(1, receiver.take(frames[1]));
}

void the_frames_of_a_set_may_come_in_any_order() {
  Sender sender;
  Receiver receiver;
  const auto frames = sender.next(1);
  TEST_ASSERT_EQUAL_DOUBLE(-1, receiver.take(frames[1]));
  TEST_ASSERT_EQUAL_DOUBLE(1, receiver.take(frames[0]));
}

void halves_of_two_sets_never_make_one() {
  Sender sender;
  Receiver receiver;
  const auto first = sender.next(1);
  const auto second = sender.next(2);
  TEST_ASSERT_EQUAL_DOUBLE(-1, receiver.take(first[0]));
  TEST_ASSERT_EQUAL_DOUBLE(-1, receiver.take(second[1]));
  TEST_ASSERT_EQUAL(1, receiver.counters().incomplete);
  TEST_ASSERT_EQUAL_DOUBLE(2, receiver.take(second[0]));
}

void a_few_lost_messages_are_counted_and_borne() {
  Sender sender;
  Receiver receiver;
  receiver.take(sender.next(0));
  for (int lost = 1; lost <= 3; ++lost) {
    for (int i = 0; i < lost; ++i) {
      sender.next(-5);
    }
    TEST_ASSERT_EQUAL_DOUBLE(lost, receiver.take(sender.next(lost)));
  }
  TEST_ASSERT_EQUAL(6, receiver.counters().lost);
}

void after_a_large_gap_the_stream_is_trusted_again_with_the_second_message() {
  Sender sender;
  Receiver receiver;
  receiver.take(sender.next(0));
  for (int i = 0; i < 6; ++i) {
    sender.next(-5);
  }
  TEST_ASSERT_EQUAL_DOUBLE(-1, receiver.take(sender.next(1)));
  TEST_ASSERT_EQUAL_DOUBLE(2, receiver.take(sender.next(2)));
  TEST_ASSERT_EQUAL(1, receiver.counters().out_of_sequence);
}

void a_repeated_message_is_ignored_and_counted() {
  Sender sender;
  Receiver receiver;
  const auto frames = sender.next(1);
  TEST_ASSERT_EQUAL_DOUBLE(1, receiver.take(frames));
  TEST_ASSERT_EQUAL_DOUBLE(-1, receiver.take(frames));
  TEST_ASSERT_EQUAL(1, receiver.counters().repeated);
  TEST_ASSERT_EQUAL(1, receiver.counters().received);
  TEST_ASSERT_FALSE(receiver.stream().has_conflict());
}

void a_late_message_is_dropped_and_counted() {
  Sender sender;
  Receiver receiver;
  const auto late = sender.next(1);
  TEST_ASSERT_EQUAL_DOUBLE(2, receiver.take(sender.next(2)));
  TEST_ASSERT_EQUAL_DOUBLE(-1, receiver.take(late));
  TEST_ASSERT_EQUAL(1, receiver.counters().old);
  TEST_ASSERT_EQUAL_DOUBLE(3, receiver.take(sender.next(3)));
}

void a_burst_of_late_messages_is_never_used_and_is_no_second_sender() {
  Sender sender;
  Receiver receiver;
  std::vector<std::vector<CanFrame>> late;
  for (int i = 0; i < 3; ++i) {
    late.push_back(sender.next(-7));
  }
  receiver.take(sender.next(1));
  for (const auto& frames : late) {
    TEST_ASSERT_EQUAL_DOUBLE(-1, receiver.take(frames));
  }
  TEST_ASSERT_EQUAL_DOUBLE(2, receiver.take(sender.next(2)));
  TEST_ASSERT_FALSE(receiver.stream().has_conflict());
}

void two_senders_are_found_whatever_their_counters() {
  for (int ahead = 0; ahead < 16; ++ahead) {
    Sender first;
    Sender second;
    Receiver receiver;
    for (int i = 0; i < ahead; ++i) {
      second.next(0);
    }
    for (int i = 0; i < 60; ++i) {
      receiver.take(first.next(100 + i));
      receiver.take(second.next(-100 - i));
    }
    TEST_ASSERT_TRUE(receiver.stream().has_conflict());
    receiver.stream().clear_conflict();
    TEST_ASSERT_FALSE(receiver.stream().has_conflict());
  }
}

void a_sender_that_starts_anew_is_accepted_after_a_pause() {
  Sender before;
  Receiver receiver;
  for (int i = 0; i < 7; ++i) {
    receiver.take(before.next(i));
  }
  receiver.wait(25 * kTick);
  Sender after;
  int accepted = 0;
  for (int i = 0; i < 10; ++i) {
    accepted += receiver.take(after.next(i)) >= 0 ? 1 : 0;
  }
  TEST_ASSERT_GREATER_OR_EQUAL(7, accepted);
}

void a_command_is_taken_from_a_program_that_starts_anew_for_each() {
  CanDecoder decoder;
  for (int i = 0; i < 3; ++i) {
    const FrameList list = CanEncoder().encode(CommandMessage{Command::arm});
    TEST_ASSERT_NOT_EQUAL(0, decoder.decode(list.frames[0], i * 25 * kTick).index());
    TEST_ASSERT_EQUAL(0, decoder.decode(list.frames[0], i * 25 * kTick + 1).index());
  }
}

/// How many data messages of a table a receiver takes that is sent by a program of its own.
int taken_of_a_table(CanDecoder* decoder, bool fd, std::int64_t* now) {
  constexpr std::uint32_t kMessages = 60;
  CanEncoder encoder(fd);
  int taken = 0;
  for (std::uint32_t i = 0; i < kMessages; ++i, *now += kTick) {
    TransferDataMessage message;
    message.word_index = i;
    message.count = 1;
    const FrameList list = encoder.encode(message);
    const Message received = decoder->decode(list.frames[0], *now);
    taken += std::holds_alternative<TransferDataMessage>(received) ? 1 : 0;
  }
  return taken;
}

void a_table_is_taken_whole_from_a_program_that_starts_anew_for_each() {
  for (const bool fd : {false, true}) {
    CanDecoder decoder;
    std::int64_t now = 0;
    for (int run = 0; run < 3; ++run, now += 1'000'000'000) {
      TEST_ASSERT_EQUAL(60, taken_of_a_table(&decoder, fd, &now));
    }
  }
}

void the_counter_wraps_without_a_loss() {
  for (const bool fd : {false, true}) {
    CanEncoder encoder(fd);
    CanDecoder decoder;
    const int messages = 600;
    int received = 0;
    for (int i = 0; i < messages; ++i) {
      const FrameList list = encoder.encode(SetpointMessage{0, {}});
      for (std::size_t k = 0; k < list.count; ++k) {
        received += decoder.decode(list.frames[k], i * kTick).index() != 0 ? 1 : 0;
      }
    }
    TEST_ASSERT_EQUAL(messages, received);
    const FrameGroup group = fd ? kFdGroup<SetpointMessage> : kClassicGroup<SetpointMessage>;
    TEST_ASSERT_EQUAL(0, decoder.monitor(group).counters.lost);
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_set_is_used_only_when_all_of_it_is_there);
  RUN_TEST(the_frames_of_a_set_may_come_in_any_order);
  RUN_TEST(halves_of_two_sets_never_make_one);
  RUN_TEST(a_few_lost_messages_are_counted_and_borne);
  RUN_TEST(after_a_large_gap_the_stream_is_trusted_again_with_the_second_message);
  RUN_TEST(a_repeated_message_is_ignored_and_counted);
  RUN_TEST(a_late_message_is_dropped_and_counted);
  RUN_TEST(a_burst_of_late_messages_is_never_used_and_is_no_second_sender);
  RUN_TEST(two_senders_are_found_whatever_their_counters);
  RUN_TEST(a_sender_that_starts_anew_is_accepted_after_a_pause);
  RUN_TEST(a_command_is_taken_from_a_program_that_starts_anew_for_each);
  RUN_TEST(a_table_is_taken_whole_from_a_program_that_starts_anew_for_each);
  RUN_TEST(the_counter_wraps_without_a_loss);
  return UNITY_END();
}
