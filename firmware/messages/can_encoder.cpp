#include "messages/can_encoder.hpp"

#include "flexcomp_can.h"
#include "messages/can_scaling.hpp"
#include "messages/e2e.hpp"

namespace flexcomp {
namespace {

constexpr std::uint8_t kClassicCounterMask = 0x0F;

/// Packs the generated struct `raw` of a frame behind those that are there.
template <typename Raw>
void append(FrameList* list, std::uint32_t id, int (*pack)(std::uint8_t*, const Raw*, std::size_t),
            Raw raw, std::uint8_t counter) {
  const FrameLayout* layout = find_layout(id);
  CanFrame& frame = list->frames[list->count++];
  frame.id = id;
  frame.size = layout->size;
  frame.fd = layout->fd;
  raw.counter = layout->fd ? counter : counter & kClassicCounterMask;
  pack(frame.data.data(), &raw, frame.size);
  protect(&frame);
}

#define APPEND(list, FRAME, frame, raw, counter) \
  append(list, FLEXCOMP_CAN_##FRAME##_FRAME_ID, flexcomp_can_##frame##_pack, raw, counter)

/// The three frames of a joint set.
#define APPEND_JOINTS(list, SET, set, q, counter) \
  do {                                            \
    flexcomp_can_##set##_a_t a{};                 \
    a.q1 = SIGNAL_RAW(set##_a, q1, 26, (q)[0]);   \
    a.q2 = SIGNAL_RAW(set##_a, q2, 26, (q)[1]);   \
    APPEND(list, SET##_A, set##_a, a, counter);   \
    flexcomp_can_##set##_b_t b{};                 \
    b.q3 = SIGNAL_RAW(set##_b, q3, 26, (q)[2]);   \
    b.q4 = SIGNAL_RAW(set##_b, q4, 26, (q)[3]);   \
    APPEND(list, SET##_B, set##_b, b, counter);   \
    flexcomp_can_##set##_c_t c{};                 \
    c.q5 = SIGNAL_RAW(set##_c, q5, 26, (q)[4]);   \
    c.q6 = SIGNAL_RAW(set##_c, q6, 26, (q)[5]);   \
    APPEND(list, SET##_C, set##_c, c, counter);   \
  } while (false)

/// The low 32 bits of the sender's clock in µs; wraps after 71 min.
std::uint32_t to_microseconds(std::int64_t nanoseconds) {
  return static_cast<std::uint32_t>(nanoseconds / 1000);
}

std::uint32_t low_word(std::uint64_t value) {
  return static_cast<std::uint32_t>(value & 0xFFFFFFFFU);
}

std::uint32_t high_word(std::uint64_t value) { return static_cast<std::uint32_t>(value >> 32); }

float single(double value) { return static_cast<float>(value); }

void encode_setpoint(const SetpointMessage& message, std::uint8_t counter, FrameList* list) {
  APPEND_JOINTS(list, SETPOINT, setpoint, message.q, counter);
}

void encode_setpoint_fd(const SetpointMessage& message, std::uint8_t counter, FrameList* list) {
  flexcomp_can_setpoint_fd_t raw{};
  raw.timestamp = to_microseconds(message.timestamp);
  raw.q1 = single(message.q[0]);
  raw.q2 = single(message.q[1]);
  raw.q3 = single(message.q[2]);
  raw.q4 = single(message.q[3]);
  raw.q5 = single(message.q[4]);
  raw.q6 = single(message.q[5]);
  APPEND(list, SETPOINT_FD, setpoint_fd, raw, counter);
}

void encode_wrench(const WrenchMessage& message, std::uint8_t counter, FrameList* list) {
  flexcomp_can_wrench_force_t force{};
  force.fx = SIGNAL_RAW(wrench_force, fx, 17, message.wrench[0]);
  force.fy = SIGNAL_RAW(wrench_force, fy, 17, message.wrench[1]);
  force.fz = SIGNAL_RAW(wrench_force, fz, 17, message.wrench[2]);
  force.saturated = message.saturated ? 1 : 0;
  APPEND(list, WRENCH_FORCE, wrench_force, force, counter);
  flexcomp_can_wrench_moment_t moment{};
  moment.mx = SIGNAL_RAW(wrench_moment, mx, 17, message.wrench[3]);
  moment.my = SIGNAL_RAW(wrench_moment, my, 17, message.wrench[4]);
  moment.mz = SIGNAL_RAW(wrench_moment, mz, 17, message.wrench[5]);
  moment.saturated = force.saturated;
  APPEND(list, WRENCH_MOMENT, wrench_moment, moment, counter);
}

void encode_wrench_fd(const WrenchMessage& message, std::uint8_t counter, FrameList* list) {
  flexcomp_can_wrench_fd_t raw{};
  raw.saturated = message.saturated ? 1 : 0;
  raw.timestamp = to_microseconds(message.timestamp);
  raw.fx = single(message.wrench[0]);
  raw.fy = single(message.wrench[1]);
  raw.fz = single(message.wrench[2]);
  raw.mx = single(message.wrench[3]);
  raw.my = single(message.wrench[4]);
  raw.mz = single(message.wrench[5]);
  APPEND(list, WRENCH_FD, wrench_fd, raw, counter);
}

void encode_corrected(const CorrectedMessage& message, std::uint8_t counter, FrameList* list) {
  APPEND_JOINTS(list, CORRECTED, corrected, message.corrected, counter);
  APPEND_JOINTS(list, UNCORRECTED, uncorrected, message.uncorrected, counter);
  flexcomp_can_status_t raw{};
  raw.status = message.status;
  raw.node_status = message.node_status;
  raw.state = message.state;
  APPEND(list, STATUS, status, raw, counter);
}

void encode_corrected_fd(const CorrectedMessage& message, std::uint8_t counter, FrameList* list) {
  flexcomp_can_corrected_fd_t raw{};
  raw.state = message.state;
  raw.timestamp = to_microseconds(message.timestamp);
  raw.q1 = single(message.corrected[0]);
  raw.q2 = single(message.corrected[1]);
  raw.q3 = single(message.corrected[2]);
  raw.q4 = single(message.corrected[3]);
  raw.q5 = single(message.corrected[4]);
  raw.q6 = single(message.corrected[5]);
  raw.uncorrected1 = single(message.uncorrected[0]);
  raw.uncorrected2 = single(message.uncorrected[1]);
  raw.uncorrected3 = single(message.uncorrected[2]);
  raw.uncorrected4 = single(message.uncorrected[3]);
  raw.uncorrected5 = single(message.uncorrected[4]);
  raw.uncorrected6 = single(message.uncorrected[5]);
  raw.status = message.status;
  raw.node_status = message.node_status;
  APPEND(list, CORRECTED_FD, corrected_fd, raw, counter);
}

void encode_identity(const IdentityMessage& message, std::uint8_t counter, FrameList* list) {
  flexcomp_can_identity_low_t low{};
  low.model_hash_low = low_word(message.model_hash);
  low.wrench_frame = static_cast<std::uint8_t>(message.wrench_frame) & 0x0FU;
  APPEND(list, IDENTITY_LOW, identity_low, low, counter);
  flexcomp_can_identity_high_t high{};
  high.model_hash_high = high_word(message.model_hash);
  APPEND(list, IDENTITY_HIGH, identity_high, high, counter);
}

void encode_position(const MeasuredPositionMessage& message, std::uint8_t counter,
                     FrameList* list) {
  flexcomp_can_measured_position_xy_t xy{};
  xy.x = SIGNAL_RAW(measured_position_xy, x, 26, message.position[0]);
  xy.y = SIGNAL_RAW(measured_position_xy, y, 26, message.position[1]);
  APPEND(list, MEASURED_POSITION_XY, measured_position_xy, xy, counter);
  flexcomp_can_measured_position_z_t z{};
  z.z = SIGNAL_RAW(measured_position_z, z, 26, message.position[2]);
  APPEND(list, MEASURED_POSITION_Z, measured_position_z, z, counter);
}

/// The gain as the signal, which is unsigned and has two bytes; its largest value if more.
template <typename Encode>
std::uint16_t gain_raw(double gain, bool (*fits)(double), Encode encode) {
  return fits(gain) ? encode(gain) : std::uint16_t{0xFFFF};
}

void encode_heartbeat(const HeartbeatMessage& message, std::uint8_t counter, FrameList* list) {
  flexcomp_can_heartbeat_t heartbeat{};
  heartbeat.uptime = message.uptime;
  heartbeat.state = message.state;
  heartbeat.slot = message.slot;
  heartbeat.table_result = message.table_result;
  APPEND(list, HEARTBEAT, heartbeat, heartbeat, counter);
  flexcomp_can_latched_t latched{};
  latched.latched_faults = message.latched_faults;
  latched.node_latched_faults = message.node_latched_faults;
  APPEND(list, LATCHED, latched, latched, counter);
  flexcomp_can_table_low_t low{};
  low.model_hash_low = low_word(message.table_model_hash);
  low.largest_gain =
      gain_raw(message.largest_gain, flexcomp_can_table_low_largest_gain_is_in_phys_range,
               flexcomp_can_table_low_largest_gain_encode);
  APPEND(list, TABLE_LOW, table_low, low, counter);
  flexcomp_can_table_high_t high{};
  high.model_hash_high = high_word(message.table_model_hash);
  APPEND(list, TABLE_HIGH, table_high, high, counter);
}

void encode_command_reply(const CommandReplyMessage& message, std::uint8_t counter,
                          FrameList* list) {
  flexcomp_can_command_reply_t raw{};
  raw.command = static_cast<std::uint8_t>(message.command);
  raw.reply = message.reply;
  raw.largest_gain =
      gain_raw(message.largest_gain, flexcomp_can_command_reply_largest_gain_is_in_phys_range,
               flexcomp_can_command_reply_largest_gain_encode);
  APPEND(list, COMMAND_REPLY, command_reply, raw, counter);
}

void encode_transfer_data(const TransferDataMessage& message, std::uint8_t counter,
                          FrameList* list) {
  flexcomp_can_transfer_data_t raw{};
  raw.word_index = message.word_index;
  raw.word = message.words[0];
  APPEND(list, TRANSFER_DATA, transfer_data, raw, counter);
}

void encode_transfer_data_fd(const TransferDataMessage& message, std::uint8_t counter,
                             FrameList* list) {
  flexcomp_can_transfer_data_fd_t raw{};
  raw.word_index = message.word_index;
  raw.words = static_cast<std::uint8_t>(message.count);
  raw.word0 = message.words[0];
  raw.word1 = message.words[1];
  raw.word2 = message.words[2];
  raw.word3 = message.words[3];
  raw.word4 = message.words[4];
  raw.word5 = message.words[5];
  raw.word6 = message.words[6];
  raw.word7 = message.words[7];
  raw.word8 = message.words[8];
  raw.word9 = message.words[9];
  raw.word10 = message.words[10];
  raw.word11 = message.words[11];
  raw.word12 = message.words[12];
  raw.word13 = message.words[13];
  APPEND(list, TRANSFER_DATA_FD, transfer_data_fd, raw, counter);
}

void encode_measured(const MeasuredJointsMessage& message, std::uint8_t counter, FrameList* list) {
  APPEND_JOINTS(list, MEASURED, measured, message.q, counter);
}

void encode_command(const CommandMessage& message, std::uint8_t counter, FrameList* list) {
  flexcomp_can_command_t raw{};
  raw.command = static_cast<std::uint8_t>(message.command);
  APPEND(list, COMMAND, command, raw, counter);
}

void encode_transfer_begin(const TransferBeginMessage& message, std::uint8_t counter,
                           FrameList* list) {
  flexcomp_can_transfer_begin_t raw{};
  raw.size = message.size;
  raw.table_crc = message.crc;
  APPEND(list, TRANSFER_BEGIN, transfer_begin, raw, counter);
}

void encode_transfer_end(const TransferEndMessage& message, std::uint8_t counter, FrameList* list) {
  flexcomp_can_transfer_end_t raw{};
  raw.table_crc = message.crc;
  APPEND(list, TRANSFER_END, transfer_end, raw, counter);
}

void encode_transfer_reply(const TransferReplyMessage& message, std::uint8_t counter,
                           FrameList* list) {
  flexcomp_can_transfer_reply_t raw{};
  raw.stage = static_cast<std::uint8_t>(message.stage);
  raw.result = message.result;
  raw.words = message.words;
  APPEND(list, TRANSFER_REPLY, transfer_reply, raw, counter);
}

void encode_fault(const FaultMessage& message, std::uint8_t counter, FrameList* list) {
  flexcomp_can_fault_t raw{};
  raw.code = message.code;
  raw.active = message.active ? 1 : 0;
  raw.detail = message.detail;
  APPEND(list, FAULT, fault, raw, counter);
}

void encode_statistic(const StatisticMessage& message, std::uint8_t counter, FrameList* list) {
  flexcomp_can_statistic_t raw{};
  raw.name = message.name;
  raw.value = message.value;
  APPEND(list, STATISTIC, statistic, raw, counter);
}

}  // namespace

void CanEncoder::put(std::monostate /*nothing*/) {}

void CanEncoder::put(const SetpointMessage& message) {
  if (fd_) {
    encode_setpoint_fd(message, next_counter(FrameGroup::setpoint_fd), &list_);
  } else {
    encode_setpoint(message, next_counter(FrameGroup::setpoint), &list_);
  }
}

void CanEncoder::put(const WrenchMessage& message) {
  if (fd_) {
    encode_wrench_fd(message, next_counter(FrameGroup::wrench_fd), &list_);
  } else {
    encode_wrench(message, next_counter(FrameGroup::wrench), &list_);
  }
}

void CanEncoder::put(const CorrectedMessage& message) {
  if (fd_) {
    encode_corrected_fd(message, next_counter(FrameGroup::corrected_fd), &list_);
  } else {
    encode_corrected(message, next_counter(FrameGroup::corrected), &list_);
  }
}

void CanEncoder::put(const TransferDataMessage& message) {
  if (fd_ && message.count <= TransferDataMessage::kMaxWords) {
    encode_transfer_data_fd(message, next_counter(FrameGroup::transfer_data_fd), &list_);
  } else if (!fd_ && message.count == 1) {
    encode_transfer_data(message, next_counter(FrameGroup::transfer_data), &list_);
  }
}

void CanEncoder::put(const CommandMessage& message) {
  encode_command(message, next_counter(FrameGroup::command), &list_);
}

void CanEncoder::put(const IdentityMessage& message) {
  encode_identity(message, next_counter(FrameGroup::identity), &list_);
}

void CanEncoder::put(const TransferBeginMessage& message) {
  encode_transfer_begin(message, next_counter(FrameGroup::transfer_begin), &list_);
}

void CanEncoder::put(const TransferEndMessage& message) {
  encode_transfer_end(message, next_counter(FrameGroup::transfer_end), &list_);
}

void CanEncoder::put(const MeasuredJointsMessage& message) {
  encode_measured(message, next_counter(FrameGroup::measured_joints), &list_);
}

void CanEncoder::put(const MeasuredPositionMessage& message) {
  encode_position(message, next_counter(FrameGroup::measured_position), &list_);
}

void CanEncoder::put(const HeartbeatMessage& message) {
  encode_heartbeat(message, next_counter(FrameGroup::heartbeat), &list_);
}

void CanEncoder::put(const FaultMessage& message) {
  encode_fault(message, next_counter(FrameGroup::fault), &list_);
}

void CanEncoder::put(const StatisticMessage& message) {
  encode_statistic(message, next_counter(FrameGroup::statistic), &list_);
}

void CanEncoder::put(const TransferReplyMessage& message) {
  encode_transfer_reply(message, next_counter(FrameGroup::transfer_reply), &list_);
}

void CanEncoder::put(const CommandReplyMessage& message) {
  encode_command_reply(message, next_counter(FrameGroup::command_reply), &list_);
}

const FrameList& CanEncoder::encode(const CorrectedMessage& message) {
  list_.count = 0;
  put(message);
  return list_;
}

const FrameList& CanEncoder::encode(const Message& message) {
  list_.count = 0;
  std::visit([this](const auto& content) { put(content); }, message);
  return list_;
}

}  // namespace flexcomp
