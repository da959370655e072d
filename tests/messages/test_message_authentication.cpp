// Attacks on messages under a key: none gets through.
#include <functional>
#include <vector>

#include "flexcomp_can.h"
#include "messages/can_decoder.hpp"
#include "messages/e2e.hpp"
#include "messages/message_authentication.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

using Frames = std::vector<CanFrame>;

constexpr Freshness kStart = 179'000'000'000'000;
constexpr Freshness kTick = 400;  // 4 ms
constexpr AuthenticationKey kKey = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};

Freshness the_time = kStart;

Freshness test_clock() { return the_time; }

AuthenticationKey other_key() {
  AuthenticationKey key = kKey;
  key.back() ^= 1U;
  return key;
}

/// A message of every covered kind.
std::vector<Message> covered_messages() {
  CorrectedMessage corrected;
  corrected.corrected = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  corrected.uncorrected = {0.1, 0.2, 0.3, 0.4, 0.5, 0.7};
  corrected.status = 5;
  return {SetpointMessage{1'000'000, {0.1, -0.2, 0.3, 0.4, 0.5, 0.6}},
          WrenchMessage{2'000'000, {100, 200, -300, 1, 2, 3}, false},
          CommandMessage{Command::arm},
          IdentityMessage{0x0123456789ABCDEF, WrenchFrame::base},
          TransferBeginMessage{4096, 0x12345678},
          TransferDataMessage{7, 1, {0xCAFE}},
          TransferEndMessage{0x12345678},
          corrected};
}

class Sender {
 public:
  explicit Sender(bool fd = false, const AuthenticationKey& key = kKey)
      : encoder_(fd), authentication_(key, test_clock) {}

  Frames next(const Message& message) {
    const SealedFrames& sealed = authentication_.seal(encoder_.encode(message));
    return {sealed.frames.begin(),
            sealed.frames.begin() + static_cast<std::ptrdiff_t>(sealed.count)};
  }

 private:
  CanEncoder encoder_;
  MessageAuthentication authentication_;
};

/// Its start lies as far back as it needs to take messages.
class Receiver {
 public:
  Receiver() { the_time += kFreshnessWindow + 1; }

  /// How many messages these frames give to the node.
  int take(const Frames& frames) {
    int messages = 0;
    for (const CanFrame& frame : frames) {
      const FrameList& admitted = authentication_.admit(frame);
      for (std::size_t i = 0; i < admitted.count; ++i) {
        const Message message = decoder_.decode(admitted.frames[i], nanoseconds());
        messages += message.index() != 0 ? 1 : 0;
        last_ = message;
      }
    }
    the_time += kTick;
    return messages;
  }

  const Message& last() const { return last_; }
  const AuthenticationCounters& refused() const { return authentication_.counters(); }
  CanDecoder& decoder() { return decoder_; }

 private:
  static std::int64_t nanoseconds() {
    return std::int64_t{10'000} * static_cast<std::int64_t>(the_time - kStart);
  }

  MessageAuthentication authentication_{kKey, test_clock};
  CanDecoder decoder_;
  Message last_;
};

void for_every_covered_message(const std::function<void(const Message&, bool fd)>& test) {
  for (const bool fd : {false, true}) {
    for (const Message& message : covered_messages()) {
      test(message, fd);
    }
  }
}

void a_genuine_message_is_the_same_as_without_a_key() {
  for_every_covered_message([](const Message& message, bool fd) {
    Receiver receiver;
    TEST_ASSERT_EQUAL(1, receiver.take(Sender(fd).next(message)));
    const FrameList before = CanEncoder(fd).encode(message);
    const FrameList after = CanEncoder(fd).encode(receiver.last());
    TEST_ASSERT_EQUAL(before.count, after.count);
    for (std::size_t i = 0; i < before.count; ++i) {
      TEST_ASSERT_EQUAL_UINT8_ARRAY(before.frames[i].data.data(), after.frames[i].data.data(), 64);
    }
  });
}

void a_message_is_held_back_until_all_of_it_is_there() {
  for_every_covered_message([](const Message& message, bool fd) {
    Receiver receiver;
    const Frames frames = Sender(fd).next(message);
    for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
      TEST_ASSERT_EQUAL(0, receiver.take({frames[i]}));
    }
    TEST_ASSERT_EQUAL(1, receiver.take({frames.back()}));
  });
}

void the_frames_before_the_authentication_may_come_in_any_order() {
  Receiver receiver;
  const Frames frames = Sender().next(covered_messages()[0]);
  TEST_ASSERT_EQUAL(1, receiver.take({frames[2], frames[0], frames[1], frames[3]}));
}

void what_is_not_covered_goes_through() {
  Receiver receiver;
  Sender sender;
  const Frames frames = sender.next(MeasuredPositionMessage{{1, 2, 3}});
  TEST_ASSERT_EQUAL(2, frames.size());
  TEST_ASSERT_EQUAL(1, receiver.take(frames));
  TEST_ASSERT_EQUAL(1, receiver.take(sender.next(FaultMessage{1, true, 2})));
}

void a_message_without_authentication_is_refused() {
  for_every_covered_message([](const Message& message, bool fd) {
    Receiver receiver;
    CanEncoder encoder(fd);
    for (int i = 0; i < 3; ++i) {
      const FrameList list = encoder.encode(message);
      TEST_ASSERT_EQUAL(
          0, receiver.take(Frames(list.frames.begin(),
                                  list.frames.begin() + static_cast<std::ptrdiff_t>(list.count))));
    }
    TEST_ASSERT_EQUAL(2, receiver.refused().unauthenticated);
  });
}

/// An attempt with the checksum of one frame as it is or made to fit again, which an attacker can
/// do. `other`, a message without its authentication, takes the place of what is left of earlier
/// attempts, so that no genuine one comes of them together.
int attempt(Receiver* receiver, const Frames& frames, const Frames& other) {
  const Freshness before = the_time;
  TEST_ASSERT_EQUAL(0, receiver->take(other));
  const int messages = receiver->take(frames);
  the_time = before;
  return messages;
}

void no_bit_can_be_changed() {
  for_every_covered_message([](const Message& message, bool fd) {
    Receiver receiver;
    Sender sender(fd);
    const Frames genuine = sender.next(message);
    Frames other = sender.next(message);
    other.pop_back();
    for (std::size_t frame = 0; frame < genuine.size(); ++frame) {
      const std::size_t checksum = genuine[frame].fd ? 16 : 8;
      for (std::size_t bit = 0; bit < std::size_t{8} * genuine[frame].size; ++bit) {
        Frames changed = genuine;
        changed[frame].data[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
        TEST_ASSERT_EQUAL(0, attempt(&receiver, changed, other));
        if (bit >= checksum) {
          protect(&changed[frame]);
          TEST_ASSERT_EQUAL(0, attempt(&receiver, changed, other));
        }
      }
    }
    TEST_ASSERT_GREATER_THAN(0, receiver.refused().forged);
    TEST_ASSERT_EQUAL(1, attempt(&receiver, genuine, other));
  });
}

void another_key_is_refused() {
  for_every_covered_message([](const Message& message, bool fd) {
    Receiver receiver;
    TEST_ASSERT_EQUAL(0, receiver.take(Sender(fd, other_key()).next(message)));
    TEST_ASSERT_EQUAL(1, receiver.refused().forged);
  });
}

void a_replayed_message_is_refused() {
  for_every_covered_message([](const Message& message, bool fd) {
    Receiver receiver;
    Sender sender(fd);
    const Frames recorded = sender.next(message);
    TEST_ASSERT_EQUAL(1, receiver.take(recorded));
    TEST_ASSERT_EQUAL(0, receiver.take(recorded));
    TEST_ASSERT_EQUAL(1, receiver.take(sender.next(message)));
    TEST_ASSERT_EQUAL(0, receiver.take(recorded));
    TEST_ASSERT_EQUAL(2, receiver.refused().not_fresh);
  });
}

/// At every age, so also where its part of the freshness value looks like a new one.
void a_replayed_message_is_refused_however_old_it_is() {
  Receiver receiver;
  Sender sender;
  const Frames recorded = sender.next(covered_messages()[0]);
  for (int i = 0; i < 30'000; ++i) {  // 120 s
    TEST_ASSERT_EQUAL(i == 0 ? 1 : 0, receiver.take(recorded));
  }
  TEST_ASSERT_GREATER_THAN(0, receiver.refused().forged);
  TEST_ASSERT_GREATER_THAN(0, receiver.refused().not_fresh);
}

void an_overtaken_message_is_refused() {
  Receiver receiver;
  Sender sender;
  const Frames first = sender.next(covered_messages()[0]);
  const Frames second = sender.next(covered_messages()[0]);
  TEST_ASSERT_EQUAL(1, receiver.take(second));
  TEST_ASSERT_EQUAL(0, receiver.take(first));
  TEST_ASSERT_EQUAL(1, receiver.refused().not_fresh);
}

void parts_of_two_genuine_messages_never_make_one() {
  Receiver receiver;
  Sender sender;
  const Frames first = sender.next(SetpointMessage{kNoTime, {1, 1, 1, 1, 1, 1}});
  for (int i = 0; i < 15; ++i) {
    sender.next(SetpointMessage{});
  }
  Frames mixed = sender.next(SetpointMessage{kNoTime, {2, 2, 2, 2, 2, 2}});  // the same counter
  mixed[1] = first[1];
  TEST_ASSERT_EQUAL(0, receiver.take(mixed));
  TEST_ASSERT_EQUAL(1, receiver.refused().forged);
}

void an_authentication_does_not_fit_another_kind_of_message() {
  Receiver receiver;
  Sender sender;
  Frames frames = sender.next(TransferEndMessage{7});
  frames[0].id = FLEXCOMP_CAN_COMMAND_FRAME_ID;
  frames[1].id = FLEXCOMP_CAN_COMMAND_AUTHENTICATION_FRAME_ID;
  protect(&frames[0]);
  protect(&frames[1]);
  TEST_ASSERT_EQUAL(0, receiver.take(frames));
  TEST_ASSERT_EQUAL(1, receiver.refused().forged);
}

void a_receiver_that_restarts_takes_nothing_from_before() {
  Receiver first;
  Sender sender;
  Frames recorded = sender.next(covered_messages()[0]);
  TEST_ASSERT_EQUAL(1, first.take(recorded));
  const Freshness restart = the_time;
  Receiver second;
  for (the_time = restart; the_time < restart + 4 * kFreshnessWindow;) {
    TEST_ASSERT_EQUAL(0, second.take(recorded));
  }
  TEST_ASSERT_EQUAL(1, second.take(sender.next(covered_messages()[0])));
}

void a_sender_that_restarts_is_taken_at_once() {
  Receiver receiver;
  TEST_ASSERT_EQUAL(1, receiver.take(Sender().next(CommandMessage{Command::arm})));
  the_time += 100'000;
  TEST_ASSERT_EQUAL(1, receiver.take(Sender().next(CommandMessage{Command::arm})));
}

void ones_own_message_played_back_is_refused() {
  MessageAuthentication node(kKey, test_clock);
  the_time += kFreshnessWindow + 1;
  const SealedFrames own = node.seal(CanEncoder().encode(covered_messages().back()));
  the_time += kTick;
  std::size_t admitted = 0;
  for (std::size_t i = 0; i < own.count; ++i) {
    admitted += node.admit(own.frames[i]).count;
  }
  TEST_ASSERT_EQUAL(0, admitted);
  TEST_ASSERT_EQUAL(1, node.counters().not_fresh);
}

/// As an attacker's frames may come between those of two messages, and his authentication before
/// the genuine one.
void what_is_left_of_a_forged_message_spoils_no_genuine_one() {
  Receiver receiver;
  Sender sender;
  Sender forger(false, other_key());
  for (int i = 0; i < 100; ++i) {
    const Frames genuine = sender.next(covered_messages()[0]);
    const Frames forged = forger.next(covered_messages()[0]);
    const std::ptrdiff_t first = i % 4;
    for (std::ptrdiff_t end = first; end <= 4; ++end) {
      TEST_ASSERT_EQUAL(0, receiver.take(Frames(forged.begin() + first, forged.begin() + end)));
    }
    TEST_ASSERT_EQUAL(1,
                      receiver.take({genuine[0], genuine[1], genuine[2], forged[3], genuine[3]}));
  }
}

/// Without a key, two senders latch the correction. With one, only who has the key can do that.
void forged_and_replayed_messages_are_no_second_sender() {
  Receiver receiver;
  Sender sender;
  Sender forger(false, other_key());
  Frames recorded = sender.next(covered_messages()[0]);
  for (int i = 0; i < 200; ++i) {
    receiver.take(forger.next(SetpointMessage{kNoTime, {1, 1, 1, 1, 1, 1}}));
    receiver.take(recorded);
    const Frames genuine = sender.next(covered_messages()[0]);
    TEST_ASSERT_EQUAL(1, receiver.take(genuine));
    recorded = genuine;
  }
  TEST_ASSERT_FALSE(receiver.decoder().monitor(kClassicGroup<SetpointMessage>).has_conflict());
  TEST_ASSERT_EQUAL(
      0, receiver.decoder().monitor(kClassicGroup<SetpointMessage>).counters.contradicting);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_genuine_message_is_the_same_as_without_a_key);
  RUN_TEST(a_message_is_held_back_until_all_of_it_is_there);
  RUN_TEST(the_frames_before_the_authentication_may_come_in_any_order);
  RUN_TEST(what_is_not_covered_goes_through);
  RUN_TEST(a_message_without_authentication_is_refused);
  RUN_TEST(no_bit_can_be_changed);
  RUN_TEST(another_key_is_refused);
  RUN_TEST(a_replayed_message_is_refused);
  RUN_TEST(a_replayed_message_is_refused_however_old_it_is);
  RUN_TEST(an_overtaken_message_is_refused);
  RUN_TEST(parts_of_two_genuine_messages_never_make_one);
  RUN_TEST(an_authentication_does_not_fit_another_kind_of_message);
  RUN_TEST(a_receiver_that_restarts_takes_nothing_from_before);
  RUN_TEST(a_sender_that_restarts_is_taken_at_once);
  RUN_TEST(ones_own_message_played_back_is_refused);
  RUN_TEST(what_is_left_of_a_forged_message_spoils_no_genuine_one);
  RUN_TEST(forged_and_replayed_messages_are_no_second_sender);
  return UNITY_END();
}
