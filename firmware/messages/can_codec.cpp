#include "messages/can_codec.hpp"

#include <cmath>
#include <limits>

#include "flexcomp_can.h"
#include "messages/can_scaling.hpp"

namespace flexcomp {
namespace {

/// The generated struct of a frame, unpacked from its payload.
template <typename Raw>
Raw unpacked(int (*unpack)(Raw*, const std::uint8_t*, std::size_t), const std::uint8_t* data,
             std::size_t size) {
  Raw raw{};
  unpack(&raw, data, size);
  return raw;
}

#define UNPACK(frame, data) unpacked(flexcomp_can_##frame##_unpack, data, sizeof(ClassicPayload))
#define UNPACK_FD(frame, data, size) unpacked(flexcomp_can_##frame##_unpack, data, size)

/// The six angles of the frames A, B and C of a joint set.
#define UNPACK_JOINTS(set, a, b, c)                                                       \
  [&]() -> JointAngles {                                                                  \
    const auto first = UNPACK(set##_a, (a).data());                                       \
    const auto second = UNPACK(set##_b, (b).data());                                      \
    const auto third = UNPACK(set##_c, (c).data());                                       \
    return {SIGNAL_VALUE(set##_a, q1, 26, first),  SIGNAL_VALUE(set##_a, q2, 26, first),  \
            SIGNAL_VALUE(set##_b, q3, 26, second), SIGNAL_VALUE(set##_b, q4, 26, second), \
            SIGNAL_VALUE(set##_c, q5, 26, third),  SIGNAL_VALUE(set##_c, q6, 26, third)}; \
  }()

std::int64_t from_microseconds(std::uint32_t time) { return std::int64_t{1000} * time; }

std::uint64_t joined(std::uint32_t low, std::uint32_t high) {
  return static_cast<std::uint64_t>(high) << 32 | low;
}

Message unpack_setpoint_fd(const std::uint8_t* data) {
  const auto raw = UNPACK_FD(setpoint_fd, data, FLEXCOMP_CAN_SETPOINT_FD_LENGTH);
  return SetpointMessage{from_microseconds(raw.timestamp),
                         {raw.q1, raw.q2, raw.q3, raw.q4, raw.q5, raw.q6}};
}

Message unpack_wrench_fd(const std::uint8_t* data) {
  const auto raw = UNPACK_FD(wrench_fd, data, FLEXCOMP_CAN_WRENCH_FD_LENGTH);
  return WrenchMessage{from_microseconds(raw.timestamp),
                       {raw.fx, raw.fy, raw.fz, raw.mx, raw.my, raw.mz},
                       raw.saturated != 0};
}

Message unpack_corrected_fd(const std::uint8_t* data) {
  const auto raw = UNPACK_FD(corrected_fd, data, FLEXCOMP_CAN_CORRECTED_FD_LENGTH);
  return CorrectedMessage{from_microseconds(raw.timestamp),
                          {raw.q1, raw.q2, raw.q3, raw.q4, raw.q5, raw.q6},
                          {raw.uncorrected1, raw.uncorrected2, raw.uncorrected3, raw.uncorrected4,
                           raw.uncorrected5, raw.uncorrected6},
                          raw.status,
                          raw.node_status,
                          raw.state};
}

Message unpack_transfer_data_fd(const std::uint8_t* data) {
  const auto raw = UNPACK_FD(transfer_data_fd, data, FLEXCOMP_CAN_TRANSFER_DATA_FD_LENGTH);
  return TransferDataMessage{
      raw.word_index,
      raw.words,
      {raw.word0, raw.word1, raw.word2, raw.word3, raw.word4, raw.word5, raw.word6, raw.word7,
       raw.word8, raw.word9, raw.word10, raw.word11, raw.word12, raw.word13}};
}

Message unpack_wrench(const FramePayloads& parts) {
  const auto force = UNPACK(wrench_force, parts[0].data());
  const auto moment = UNPACK(wrench_moment, parts[1].data());
  return WrenchMessage{
      kNoTime,
      {SIGNAL_VALUE(wrench_force, fx, 17, force), SIGNAL_VALUE(wrench_force, fy, 17, force),
       SIGNAL_VALUE(wrench_force, fz, 17, force), SIGNAL_VALUE(wrench_moment, mx, 17, moment),
       SIGNAL_VALUE(wrench_moment, my, 17, moment), SIGNAL_VALUE(wrench_moment, mz, 17, moment)},
      (force.saturated | moment.saturated) != 0};
}

Message unpack_position(const FramePayloads& parts) {
  const auto xy = UNPACK(measured_position_xy, parts[0].data());
  const auto z = UNPACK(measured_position_z, parts[1].data());
  return MeasuredPositionMessage{{SIGNAL_VALUE(measured_position_xy, x, 26, xy),
                                  SIGNAL_VALUE(measured_position_xy, y, 26, xy),
                                  SIGNAL_VALUE(measured_position_z, z, 26, z)}};
}

Message unpack_corrected(const FramePayloads& parts) {
  const auto status = UNPACK(status, parts[6].data());
  return CorrectedMessage{kNoTime,
                          UNPACK_JOINTS(corrected, parts[0], parts[1], parts[2]),
                          UNPACK_JOINTS(uncorrected, parts[3], parts[4], parts[5]),
                          status.status,
                          status.node_status,
                          status.state};
}

Message unpack_heartbeat(const FramePayloads& parts) {
  const auto heartbeat = UNPACK(heartbeat, parts[0].data());
  const auto latched = UNPACK(latched, parts[1].data());
  const auto low = UNPACK(table_low, parts[2].data());
  const auto high = UNPACK(table_high, parts[3].data());
  return HeartbeatMessage{heartbeat.uptime,
                          heartbeat.state,
                          heartbeat.slot,
                          heartbeat.table_result,
                          latched.latched_faults,
                          latched.node_latched_faults,
                          joined(low.model_hash_low, high.model_hash_high),
                          flexcomp_can_table_low_largest_gain_decode(low.largest_gain)};
}

Message unpack_identity(const FramePayloads& parts) {
  const auto low = UNPACK(identity_low, parts[0].data());
  const auto high = UNPACK(identity_high, parts[1].data());
  return IdentityMessage{joined(low.model_hash_low, high.model_hash_high),
                         static_cast<WrenchFrame>(low.wrench_frame)};
}

Message unpack_transfer_data(const std::uint8_t* data) {
  const auto raw = UNPACK(transfer_data, data);
  TransferDataMessage message{raw.word_index, 1, {}};
  message.words[0] = raw.word;
  return message;
}

Message unpack_fault(const std::uint8_t* data) {
  const auto raw = UNPACK(fault, data);
  return FaultMessage{raw.code, raw.active != 0, raw.detail};
}

Message unpack_command_reply(const std::uint8_t* data) {
  const auto raw = UNPACK(command_reply, data);
  return CommandReplyMessage{static_cast<Command>(raw.command), raw.reply,
                             flexcomp_can_command_reply_largest_gain_decode(raw.largest_gain)};
}

Message unpack_transfer_reply(const std::uint8_t* data) {
  const auto raw = UNPACK(transfer_reply, data);
  return TransferReplyMessage{static_cast<TransferStage>(raw.stage), raw.result, raw.words};
}

Message unpack_transfer_begin(const std::uint8_t* data) {
  const auto raw = UNPACK(transfer_begin, data);
  return TransferBeginMessage{raw.size, raw.table_crc};
}

}  // namespace

Message unpack_message(std::uint32_t id, const std::uint8_t* data) {
  switch (id) {
    case FLEXCOMP_CAN_FAULT_FRAME_ID:
      return unpack_fault(data);
    case FLEXCOMP_CAN_SETPOINT_FD_FRAME_ID:
      return unpack_setpoint_fd(data);
    case FLEXCOMP_CAN_WRENCH_FD_FRAME_ID:
      return unpack_wrench_fd(data);
    case FLEXCOMP_CAN_COMMAND_FRAME_ID:
      return CommandMessage{static_cast<Command>(UNPACK(command, data).command)};
    case FLEXCOMP_CAN_TRANSFER_BEGIN_FRAME_ID:
      return unpack_transfer_begin(data);
    case FLEXCOMP_CAN_TRANSFER_DATA_FRAME_ID:
      return unpack_transfer_data(data);
    case FLEXCOMP_CAN_TRANSFER_END_FRAME_ID:
      return TransferEndMessage{UNPACK(transfer_end, data).table_crc};
    case FLEXCOMP_CAN_TRANSFER_DATA_FD_FRAME_ID:
      return unpack_transfer_data_fd(data);
    case FLEXCOMP_CAN_CORRECTED_FD_FRAME_ID:
      return unpack_corrected_fd(data);
    case FLEXCOMP_CAN_STATISTIC_FRAME_ID: {
      const auto raw = UNPACK(statistic, data);
      return StatisticMessage{raw.name, raw.value};
    }
    case FLEXCOMP_CAN_TRANSFER_REPLY_FRAME_ID:
      return unpack_transfer_reply(data);
    case FLEXCOMP_CAN_COMMAND_REPLY_FRAME_ID:
      return unpack_command_reply(data);
    default:
      return {};
  }
}

Message unpack_set(FrameGroup group, const FramePayloads& parts) {
  switch (group) {
    case FrameGroup::setpoint:
      return SetpointMessage{kNoTime, UNPACK_JOINTS(setpoint, parts[0], parts[1], parts[2])};
    case FrameGroup::wrench:
      return unpack_wrench(parts);
    case FrameGroup::identity:
      return unpack_identity(parts);
    case FrameGroup::measured_joints:
      return MeasuredJointsMessage{UNPACK_JOINTS(measured, parts[0], parts[1], parts[2])};
    case FrameGroup::measured_position:
      return unpack_position(parts);
    case FrameGroup::corrected:
      return unpack_corrected(parts);
    case FrameGroup::heartbeat:
      return unpack_heartbeat(parts);
    default:
      return {};
  }
}

}  // namespace flexcomp
