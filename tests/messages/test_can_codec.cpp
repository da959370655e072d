// Every message through frames and back, at the ends of its range, and every single bit flipped.
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "messages/can_decoder.hpp"
#include "messages/can_encoder.hpp"
#include "messages/e2e.hpp"
#include "one_of_each.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kAngleStep = 2e-7;
constexpr double kLargestAngle = 33549999 * kAngleStep;  // within ±6.71 rad

/// The message that the frames of `message` make on the other side.
Message through_frames(const Message& message, bool fd) {
  CanEncoder encoder(fd);
  CanDecoder decoder;
  const FrameList list = encoder.encode(message);
  TEST_ASSERT_GREATER_THAN(0, list.count);
  Message received;
  for (std::size_t i = 0; i < list.count; ++i) {
    TEST_ASSERT_EQUAL(0, received.index());
    received = decoder.decode(list.frames[i], 0);
  }
  TEST_ASSERT_EQUAL(message.index(), received.index());
  return received;
}

template <typename Kind>
Kind through(const Kind& message, bool fd = false) {
  return std::get<Kind>(through_frames(message, fd));
}

std::vector<CanFrame> frames_of_everything() {
  std::vector<CanFrame> frames;
  for (const bool fd : {false, true}) {
    CanEncoder encoder(fd);
    for (const Message& message : test::one_of_each()) {
      const FrameList list = encoder.encode(message);
      frames.insert(frames.end(), list.frames.begin(),
                    list.frames.begin() + static_cast<std::ptrdiff_t>(list.count));
    }
  }
  return frames;
}

/// Any payload through both codecs: that by words and that of cantools.
template <typename Raw, typename Pack, typename Unpack>
void check_words(std::size_t size, const Pack& pack, const Unpack& unpack) {
  std::mt19937 random(static_cast<unsigned>(size));
  for (int round = 0; round < 100; ++round) {
    std::array<std::uint32_t, 16> payload{};
    for (std::uint32_t& word : payload) {
      word = round == 0 ? 0xFFFFFFFFU : static_cast<std::uint32_t>(random());
    }
    std::array<std::uint8_t, 64> bytes{};
    std::memcpy(bytes.data(), payload.data(), size);
    Raw theirs{};
    TEST_ASSERT_EQUAL(0, unpack(&theirs, bytes.data(), size));
    Raw ours{};
    can::Words<Raw>::unpack(payload.data(), &ours);
    std::array<std::uint8_t, 64> their_bytes{};
    std::array<std::uint8_t, 64> of_ours{};
    TEST_ASSERT_EQUAL(static_cast<int>(size), pack(their_bytes.data(), &theirs, size));
    pack(of_ours.data(), &ours, size);
    TEST_ASSERT_EQUAL_MEMORY(their_bytes.data(), of_ours.data(), size);
    std::array<std::uint32_t, 16> words{};
    can::Words<Raw>::pack(theirs, words.data());
    TEST_ASSERT_EQUAL_MEMORY(their_bytes.data(), words.data(), size);
  }
}

#define CHECK_WORDS(NAME, name)                                                                  \
  check_words<flexcomp_can_##name##_t>(FLEXCOMP_CAN_##NAME##_LENGTH, flexcomp_can_##name##_pack, \
                                       flexcomp_can_##name##_unpack)

void frames_are_packed_by_words_as_cantools_packs_them() {
  CHECK_WORDS(FAULT, fault);
  CHECK_WORDS(SETPOINT_A, setpoint_a);
  CHECK_WORDS(SETPOINT_B, setpoint_b);
  CHECK_WORDS(SETPOINT_C, setpoint_c);
  CHECK_WORDS(SETPOINT_AUTHENTICATION, setpoint_authentication);
  CHECK_WORDS(SETPOINT_FD, setpoint_fd);
  CHECK_WORDS(SETPOINT_FD_AUTHENTICATION, setpoint_fd_authentication);
  CHECK_WORDS(WRENCH_FORCE, wrench_force);
  CHECK_WORDS(WRENCH_MOMENT, wrench_moment);
  CHECK_WORDS(WRENCH_AUTHENTICATION, wrench_authentication);
  CHECK_WORDS(WRENCH_FD, wrench_fd);
  CHECK_WORDS(WRENCH_FD_AUTHENTICATION, wrench_fd_authentication);
  CHECK_WORDS(COMMAND, command);
  CHECK_WORDS(IDENTITY_LOW, identity_low);
  CHECK_WORDS(IDENTITY_HIGH, identity_high);
  CHECK_WORDS(COMMAND_AUTHENTICATION, command_authentication);
  CHECK_WORDS(IDENTITY_AUTHENTICATION, identity_authentication);
  CHECK_WORDS(TRANSFER_BEGIN, transfer_begin);
  CHECK_WORDS(TRANSFER_DATA, transfer_data);
  CHECK_WORDS(TRANSFER_END, transfer_end);
  CHECK_WORDS(TRANSFER_BEGIN_AUTHENTICATION, transfer_begin_authentication);
  CHECK_WORDS(TRANSFER_DATA_AUTHENTICATION, transfer_data_authentication);
  CHECK_WORDS(TRANSFER_END_AUTHENTICATION, transfer_end_authentication);
  CHECK_WORDS(TRANSFER_DATA_FD, transfer_data_fd);
  CHECK_WORDS(TRANSFER_DATA_FD_AUTHENTICATION, transfer_data_fd_authentication);
  CHECK_WORDS(MEASURED_A, measured_a);
  CHECK_WORDS(MEASURED_B, measured_b);
  CHECK_WORDS(MEASURED_C, measured_c);
  CHECK_WORDS(MEASURED_POSITION_XY, measured_position_xy);
  CHECK_WORDS(MEASURED_POSITION_Z, measured_position_z);
  CHECK_WORDS(CORRECTED_A, corrected_a);
  CHECK_WORDS(CORRECTED_B, corrected_b);
  CHECK_WORDS(CORRECTED_C, corrected_c);
  CHECK_WORDS(UNCORRECTED_A, uncorrected_a);
  CHECK_WORDS(UNCORRECTED_B, uncorrected_b);
  CHECK_WORDS(UNCORRECTED_C, uncorrected_c);
  CHECK_WORDS(CORRECTED_FD, corrected_fd);
  CHECK_WORDS(STATUS, status);
  CHECK_WORDS(LATCHED, latched);
  CHECK_WORDS(CORRECTED_AUTHENTICATION, corrected_authentication);
  CHECK_WORDS(CORRECTED_FD_AUTHENTICATION, corrected_fd_authentication);
  CHECK_WORDS(HEARTBEAT, heartbeat);
  CHECK_WORDS(TABLE_LOW, table_low);
  CHECK_WORDS(TABLE_HIGH, table_high);
  CHECK_WORDS(STATISTIC, statistic);
  CHECK_WORDS(TRANSFER_REPLY, transfer_reply);
  CHECK_WORDS(COMMAND_REPLY, command_reply);
}

void angles_keep_their_value_to_a_tenth_of_a_microradian() {
  for (const double angle : {0.0, 1.23456789, -2.5, kLargestAngle, -kLargestAngle}) {
    const auto back = through(SetpointMessage{kNoTime, {angle, 0, -angle, 0, angle, -angle}});
    TEST_ASSERT_DOUBLE_WITHIN(kAngleStep / 2 + 1e-15, angle, back.q[0]);
    TEST_ASSERT_DOUBLE_WITHIN(kAngleStep / 2 + 1e-15, -angle, back.q[2]);
    TEST_ASSERT_DOUBLE_WITHIN(kAngleStep / 2 + 1e-15, angle, back.q[4]);
    TEST_ASSERT_DOUBLE_WITHIN(kAngleStep / 2 + 1e-15, -angle, back.q[5]);
  }
}

void each_angle_travels_in_its_own_place() {
  for (std::size_t k = 0; k < 6; ++k) {
    JointAngles q{};
    q[k] = -6.7;
    for (const bool fd : {false, true}) {
      const auto back = through(CorrectedMessage{kNoTime, q, {}, 0, 0, 0}, fd);
      const auto other = through(CorrectedMessage{kNoTime, {}, q, 0, 0, 0}, fd);
      for (std::size_t i = 0; i < 6; ++i) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, i == k ? -6.7 : 0, back.corrected[i]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0, back.uncorrected[i]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, i == k ? -6.7 : 0, other.uncorrected[i]);
      }
    }
  }
}

void what_is_not_finite_or_does_not_fit_arrives_as_not_available() {
  for (const double bad : {kNan, HUGE_VAL, -HUGE_VAL, 6.72, -6.72, 1e300}) {
    const auto setpoint = through(SetpointMessage{kNoTime, {0, bad, 0, 0, 0, 0}});
    TEST_ASSERT_TRUE(std::isnan(setpoint.q[1]));
    TEST_ASSERT_EQUAL_DOUBLE(0, setpoint.q[0]);
  }
  const auto wrench =
      through(WrenchMessage{kNoTime, {6553.6, -6553.6, 0, 655.36, 1e9, kNan}, false});
  TEST_ASSERT_TRUE(std::isnan(wrench.wrench[0]));
  TEST_ASSERT_TRUE(std::isnan(wrench.wrench[1]));
  TEST_ASSERT_EQUAL_DOUBLE(0, wrench.wrench[2]);
  TEST_ASSERT_TRUE(std::isnan(wrench.wrench[3]));
  TEST_ASSERT_TRUE(std::isnan(wrench.wrench[5]));
}

void an_fd_frame_carries_what_is_not_finite_as_it_is() {
  const auto back = through(SetpointMessage{5000, {kNan, HUGE_VAL, -HUGE_VAL, 0, 1, -1}}, true);
  TEST_ASSERT_TRUE(std::isnan(back.q[0]));
  TEST_ASSERT_TRUE(back.q[1] == HUGE_VAL);
  TEST_ASSERT_TRUE(back.q[2] == -HUGE_VAL);
  TEST_ASSERT_EQUAL(5000, back.timestamp);
}

void wrenches_reach_the_ends_of_their_range() {
  for (const double sign : {1.0, -1.0}) {
    for (const bool fd : {false, true}) {
      const auto back = through(WrenchMessage{0,
                                              {sign * 6553.5, -sign * 6553.5, sign * 0.1,
                                               sign * 655.35, -sign * 655.35, sign * 0.01},
                                              sign > 0},
                                fd);
      TEST_ASSERT_DOUBLE_WITHIN(1e-3, sign * 6553.5, back.wrench[0]);
      TEST_ASSERT_DOUBLE_WITHIN(1e-3, -sign * 6553.5, back.wrench[1]);
      TEST_ASSERT_DOUBLE_WITHIN(1e-8, sign * 0.1, back.wrench[2]);
      TEST_ASSERT_DOUBLE_WITHIN(1e-4, sign * 655.35, back.wrench[3]);
      TEST_ASSERT_DOUBLE_WITHIN(1e-4, -sign * 655.35, back.wrench[4]);
      TEST_ASSERT_DOUBLE_WITHIN(1e-9, sign * 0.01, back.wrench[5]);
      TEST_ASSERT_EQUAL(sign > 0, back.saturated);
    }
  }
}

void positions_reach_the_ends_of_their_range() {
  const auto back = through(MeasuredPositionMessage{{kLargestAngle, -kLargestAngle, -6.7}});
  TEST_ASSERT_DOUBLE_WITHIN(1e-7, kLargestAngle, back.position[0]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-7, -kLargestAngle, back.position[1]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-7, -6.7, back.position[2]);
  const auto joints = through(MeasuredJointsMessage{{6.7, -6.7, 6.7, -6.7, 6.7, -6.7}});
  for (std::size_t i = 0; i < 6; ++i) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, i % 2 == 0 ? 6.7 : -6.7, joints.q[i]);
  }
}

void integers_keep_all_their_bits() {
  for (const bool full : {false, true}) {
    const std::uint32_t word = full ? 0xFFFFFFFF : 0;
    const auto u16 = static_cast<std::uint16_t>(word);
    const auto u8 = static_cast<std::uint8_t>(word);
    const std::uint64_t long_word = full ? ~std::uint64_t{0} : 0;
    const std::uint32_t bits20 = word & 0xFFFFF;

    const auto corrected = through(
        CorrectedMessage{kNoTime, {}, {}, word, u16, full ? std::uint8_t{15} : std::uint8_t{0}});
    TEST_ASSERT_EQUAL_HEX32(word, corrected.status);
    TEST_ASSERT_EQUAL_HEX16(u16, corrected.node_status);
    TEST_ASSERT_EQUAL(full ? 15 : 0, corrected.state);
    const auto corrected_fd = through(CorrectedMessage{0, {}, {}, word, u16, u8}, true);
    TEST_ASSERT_EQUAL_HEX32(word, corrected_fd.status);
    TEST_ASSERT_EQUAL_HEX16(u16, corrected_fd.node_status);
    TEST_ASSERT_EQUAL(u8, corrected_fd.state);

    const auto beat = through(HeartbeatMessage{word, 15, 3, u8, word, u16, long_word, 6.5535});
    TEST_ASSERT_EQUAL_HEX32(word, beat.uptime);
    TEST_ASSERT_EQUAL(15, beat.state);
    TEST_ASSERT_EQUAL(3, beat.slot);
    TEST_ASSERT_EQUAL(u8, beat.table_result);
    TEST_ASSERT_EQUAL_HEX32(word, beat.latched_faults);
    TEST_ASSERT_EQUAL_HEX16(u16, beat.node_latched_faults);
    TEST_ASSERT_EQUAL_HEX64(long_word, beat.table_model_hash);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 6.5535, beat.largest_gain);

    const auto fault = through(FaultMessage{u16, full, word});
    TEST_ASSERT_EQUAL_HEX16(u16, fault.code);
    TEST_ASSERT_EQUAL(full, fault.active);
    TEST_ASSERT_EQUAL_HEX32(word, fault.detail);

    const auto statistic = through(StatisticMessage{u8, long_word & 0xFFFFFFFFFFF});
    TEST_ASSERT_EQUAL_HEX64(long_word & 0xFFFFFFFFFFF, statistic.value);
    TEST_ASSERT_EQUAL(u8, statistic.name);

    const auto begin = through(TransferBeginMessage{bits20, word});
    TEST_ASSERT_EQUAL_HEX32(bits20, begin.size);
    TEST_ASSERT_EQUAL_HEX32(word, begin.crc);
    TEST_ASSERT_EQUAL_HEX32(word, through(TransferEndMessage{word}).crc);

    TransferDataMessage data{bits20, 1, {}};
    data.words[0] = word;
    const auto classic = through(data);
    TEST_ASSERT_EQUAL_HEX32(bits20, classic.word_index);
    TEST_ASSERT_EQUAL_HEX32(word, classic.words[0]);
    data.word_index = word;
    data.count = TransferDataMessage::kMaxWords;
    data.words.fill(word);
    data.words[13] = 0x12345678;
    const auto wide = through(data, true);
    TEST_ASSERT_EQUAL_HEX32(word, wide.word_index);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(data.words.data(), wide.words.data(), data.words.size());

    const auto identity = through(IdentityMessage{long_word, WrenchFrame::sensor});
    TEST_ASSERT_EQUAL_HEX64(long_word, identity.model_hash);
    TEST_ASSERT_EQUAL(WrenchFrame::sensor, identity.wrench_frame);

    const auto reply = through(TransferReplyMessage{TransferStage::data, u8, bits20});
    TEST_ASSERT_EQUAL(u8, reply.result);
    TEST_ASSERT_EQUAL_HEX32(bits20, reply.words);
    const auto answer = through(CommandReplyMessage{Command::report, u8, full ? 6.5535 : 0});
    TEST_ASSERT_EQUAL(u8, answer.reply);
    TEST_ASSERT_EQUAL(Command::report, answer.command);
  }
}

void every_message_arrives_as_its_kind() {
  for (const bool fd : {false, true}) {
    for (const Message& message : test::one_of_each()) {
      through_frames(message, fd);
    }
  }
}

/// test_frames.py says that the first frames are right; then each field came back in its own place.
void what_arrives_makes_the_same_frames_again() {
  for (const bool fd : {false, true}) {
    for (const Message& message : test::one_of_each()) {
      const FrameList sent = CanEncoder(fd).encode(message);
      const FrameList again = CanEncoder(fd).encode(through_frames(message, fd));
      TEST_ASSERT_EQUAL(sent.count, again.count);
      for (std::size_t i = 0; i < sent.count; ++i) {
        TEST_ASSERT_EQUAL(sent.frames[i].id, again.frames[i].id);
        TEST_ASSERT_TRUE(sent.frames[i].data == again.frames[i].data);
      }
    }
  }
}

void a_frame_with_any_single_bit_flipped_is_rejected() {
  int tried = 0;
  for (const CanFrame& frame : frames_of_everything()) {
    for (std::size_t bit = 0; bit < 8U * frame.size; ++bit) {
      CanFrame damaged = frame;
      damaged.data[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
      TEST_ASSERT_FALSE(is_intact(damaged));
      CanDecoder decoder;
      TEST_ASSERT_EQUAL(0, decoder.decode(damaged, 0).index());
      ++tried;
    }
  }
  TEST_ASSERT_GREATER_THAN(4000, tried);
}

void a_frame_with_any_two_bits_flipped_is_rejected() {
  for (const CanFrame& frame : frames_of_everything()) {
    for (std::size_t first = 0; first < 8U * frame.size; ++first) {
      for (std::size_t second = 0; second < first; ++second) {
        CanFrame damaged = frame;
        damaged.data[first / 8] ^= static_cast<std::uint8_t>(1U << first % 8);
        damaged.data[second / 8] ^= static_cast<std::uint8_t>(1U << second % 8);
        TEST_ASSERT_FALSE(is_intact(damaged));
      }
    }
  }
}

/// One bit of one frame, in identifier, data, length or format: no message comes of the set,
/// whatever the damaged frame is taken for.
void a_set_with_any_single_bit_of_any_frame_flipped_is_no_message() {
  constexpr std::size_t kIdBits = 11;
  constexpr std::size_t kLengthBits = 7;
  int tried = 0;
  const auto assert_no_message = [&](FrameList list, std::size_t place, std::size_t bit) {
    CanFrame& frame = list.frames[place];
    const std::size_t data_bits = 8U * frame.size;
    if (bit < data_bits) {
      frame.data[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    } else if (bit < data_bits + kIdBits) {
      frame.id ^= 1U << (bit - data_bits);
    } else if (bit < data_bits + kIdBits + kLengthBits) {
      frame.size ^= static_cast<std::uint8_t>(1U << (bit - data_bits - kIdBits));
    } else {
      frame.fd = !frame.fd;
    }
    CanDecoder decoder;
    for (std::size_t i = 0; i < list.count; ++i) {
      TEST_ASSERT_EQUAL(0, decoder.decode(list.frames[i], 0).index());
    }
    ++tried;
  };
  for (const bool fd : {false, true}) {
    for (const Message& message : test::one_of_each()) {
      const FrameList list = CanEncoder(fd).encode(message);
      for (std::size_t place = 0; place < list.count; ++place) {
        const std::size_t bits = 8U * list.frames[place].size + kIdBits + kLengthBits + 1;
        for (std::size_t bit = 0; bit < bits; ++bit) {
          assert_no_message(list, place, bit);
        }
      }
    }
  }
  TEST_ASSERT_GREATER_THAN(5000, tried);
}

/// Up to as many bits in a row as the checksum has, in the order in which it takes them.
void a_burst_in_the_data_of_a_frame_is_rejected() {
  for (const CanFrame& frame : frames_of_everything()) {
    const std::size_t checksum_bits = frame.fd ? 16 : 8;
    const std::size_t end = 8U * frame.size;
    const unsigned patterns = frame.fd ? 1U << 8 : 1U << 7;  // FD: every other of the inner bits
    for (std::size_t first = checksum_bits; first < end; ++first) {
      for (unsigned pattern = 0; pattern < patterns; ++pattern) {
        CanFrame damaged = frame;
        const std::size_t spread = frame.fd ? 2 : 1;
        const auto flip = [&](std::size_t bit) {
          if (bit < end) {
            damaged.data[bit / 8] ^= static_cast<std::uint8_t>(0x80U >> bit % 8);
          }
        };
        flip(first);
        for (std::size_t i = 0; (pattern >> i) != 0; ++i) {
          if ((pattern >> i & 1U) != 0) {
            flip(first + 1 + spread * i);
          }
        }
        TEST_ASSERT_FALSE(is_intact(damaged));
      }
    }
  }
}

void a_frame_under_the_identifier_of_another_of_ours_is_rejected() {
  for (const CanFrame& frame : frames_of_everything()) {
    for (std::uint32_t id = 0; id < 0x800; ++id) {
      CanFrame masked = frame;
      masked.id = id;
      if (find_layout(id) != nullptr) {
        TEST_ASSERT_EQUAL(id == frame.id, is_intact(masked));
      }
    }
  }
}

void a_frame_of_another_length_or_format_is_rejected() {
  for (CanFrame frame : frames_of_everything()) {
    const std::uint8_t size = frame.size;
    for (std::uint8_t other = 0; other <= 64; ++other) {
      frame.size = other;
      protect(&frame);
      CanDecoder decoder;
      const FrameLayout* layout = find_layout(frame.id);
      decoder.decode(frame, 0);
      TEST_ASSERT_EQUAL(other == size ? 0 : 1, decoder.monitor(layout->group).counters.corrupt);
    }
    frame.size = size;
    frame.fd = !frame.fd;
    protect(&frame);
    CanDecoder decoder;
    TEST_ASSERT_EQUAL(0, decoder.decode(frame, 0).index());
  }
}

void frames_that_are_not_ours_are_counted_and_left_alone() {
  CanDecoder decoder;
  CanFrame frame;
  frame.id = 0x7FF;
  frame.size = 8;
  TEST_ASSERT_EQUAL(0, decoder.decode(frame, 0).index());
  TEST_ASSERT_EQUAL(1, decoder.foreign_frames());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(frames_are_packed_by_words_as_cantools_packs_them);
  RUN_TEST(angles_keep_their_value_to_a_tenth_of_a_microradian);
  RUN_TEST(each_angle_travels_in_its_own_place);
  RUN_TEST(what_is_not_finite_or_does_not_fit_arrives_as_not_available);
  RUN_TEST(an_fd_frame_carries_what_is_not_finite_as_it_is);
  RUN_TEST(wrenches_reach_the_ends_of_their_range);
  RUN_TEST(positions_reach_the_ends_of_their_range);
  RUN_TEST(integers_keep_all_their_bits);
  RUN_TEST(every_message_arrives_as_its_kind);
  RUN_TEST(what_arrives_makes_the_same_frames_again);
  RUN_TEST(a_frame_with_any_single_bit_flipped_is_rejected);
  RUN_TEST(a_frame_with_any_two_bits_flipped_is_rejected);
  RUN_TEST(a_set_with_any_single_bit_of_any_frame_flipped_is_no_message);
  RUN_TEST(a_burst_in_the_data_of_a_frame_is_rejected);
  RUN_TEST(a_frame_under_the_identifier_of_another_of_ours_is_rejected);
  RUN_TEST(a_frame_of_another_length_or_format_is_rejected);
  RUN_TEST(frames_that_are_not_ours_are_counted_and_left_alone);
  return UNITY_END();
}
