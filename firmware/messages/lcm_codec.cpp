#include "messages/lcm_codec.hpp"

#include <algorithm>
#include <type_traits>

// The generated headers define functions that are not inline: only this file may include them.
#include "flexcomp_lcm/command.hpp"
#include "flexcomp_lcm/command_reply.hpp"
#include "flexcomp_lcm/corrected_setpoint.hpp"
#include "flexcomp_lcm/fault.hpp"
#include "flexcomp_lcm/heartbeat.hpp"
#include "flexcomp_lcm/identity.hpp"
#include "flexcomp_lcm/joint_setpoint.hpp"
#include "flexcomp_lcm/measured_joints.hpp"
#include "flexcomp_lcm/measured_position.hpp"
#include "flexcomp_lcm/statistic.hpp"
#include "flexcomp_lcm/table_begin.hpp"
#include "flexcomp_lcm/table_data.hpp"
#include "flexcomp_lcm/table_end.hpp"
#include "flexcomp_lcm/table_reply.hpp"
#include "flexcomp_lcm/wrench.hpp"

namespace flexcomp {
namespace {

template <typename Type>
constexpr const char* kChannel = nullptr;
template <>
constexpr const char* kChannel<flexcomp_lcm::command> = "FLEXCOMP_COMMAND";
template <>
constexpr const char* kChannel<flexcomp_lcm::command_reply> = "FLEXCOMP_COMMAND_REPLY";
template <>
constexpr const char* kChannel<flexcomp_lcm::corrected_setpoint> = "FLEXCOMP_CORRECTED_SETPOINT";
template <>
constexpr const char* kChannel<flexcomp_lcm::fault> = "FLEXCOMP_FAULT";
template <>
constexpr const char* kChannel<flexcomp_lcm::heartbeat> = "FLEXCOMP_HEARTBEAT";
template <>
constexpr const char* kChannel<flexcomp_lcm::identity> = "FLEXCOMP_IDENTITY";
template <>
constexpr const char* kChannel<flexcomp_lcm::joint_setpoint> = "FLEXCOMP_JOINT_SETPOINT";
template <>
constexpr const char* kChannel<flexcomp_lcm::measured_joints> = "FLEXCOMP_MEASURED_JOINTS";
template <>
constexpr const char* kChannel<flexcomp_lcm::measured_position> = "FLEXCOMP_MEASURED_POSITION";
template <>
constexpr const char* kChannel<flexcomp_lcm::statistic> = "FLEXCOMP_STATISTIC";
template <>
constexpr const char* kChannel<flexcomp_lcm::table_begin> = "FLEXCOMP_TABLE_BEGIN";
template <>
constexpr const char* kChannel<flexcomp_lcm::table_data> = "FLEXCOMP_TABLE_DATA";
template <>
constexpr const char* kChannel<flexcomp_lcm::table_end> = "FLEXCOMP_TABLE_END";
template <>
constexpr const char* kChannel<flexcomp_lcm::table_reply> = "FLEXCOMP_TABLE_REPLY";
template <>
constexpr const char* kChannel<flexcomp_lcm::wrench> = "FLEXCOMP_WRENCH";

template <typename Type>
Type stamped(std::int64_t sequence, std::int64_t now) {
  Type type{};
  type.sequence = sequence;
  type.timestamp = now;
  return type;
}

/// Encodes a message of one kind; the overloads below fill the generated types.
struct Encoder {
  std::int64_t sequence;
  std::int64_t now;

  template <typename Type>
  static LcmEvent event(const Type& type) {
    LcmEvent event;
    event.channel = kChannel<Type>;
    event.data.resize(static_cast<std::size_t>(type.getEncodedSize()));
    type.encode(event.data.data(), 0, static_cast<int>(event.data.size()));
    return event;
  }

  LcmEvent operator()(std::monostate /*nothing*/) const { return {}; }

  LcmEvent operator()(const SetpointMessage& message) const {
    auto type = stamped<flexcomp_lcm::joint_setpoint>(sequence, now);
    std::copy(message.q.begin(), message.q.end(), type.position);
    return event(type);
  }

  LcmEvent operator()(const WrenchMessage& message) const {
    auto type = stamped<flexcomp_lcm::wrench>(sequence, now);
    std::copy_n(message.wrench.begin(), 3, type.force);
    std::copy_n(message.wrench.begin() + 3, 3, type.moment);
    type.saturated = message.saturated ? 1 : 0;
    return event(type);
  }

  LcmEvent operator()(const CorrectedMessage& message) const {
    auto type = stamped<flexcomp_lcm::corrected_setpoint>(sequence, now);
    type.setpoint_timestamp = message.timestamp;
    std::copy(message.corrected.begin(), message.corrected.end(), type.corrected);
    std::copy(message.uncorrected.begin(), message.uncorrected.end(), type.uncorrected);
    type.status = message.status;
    type.node_status = message.node_status;
    type.state = static_cast<std::int8_t>(message.state);
    return event(type);
  }

  LcmEvent operator()(const CommandMessage& message) const {
    auto type = stamped<flexcomp_lcm::command>(sequence, now);
    type.command = static_cast<std::int8_t>(message.command);
    return event(type);
  }

  LcmEvent operator()(const CommandReplyMessage& message) const {
    auto type = stamped<flexcomp_lcm::command_reply>(sequence, now);
    type.command = static_cast<std::int8_t>(message.command);
    type.reply = message.reply;
    type.largest_gain = message.largest_gain;
    return event(type);
  }

  LcmEvent operator()(const IdentityMessage& message) const {
    auto type = stamped<flexcomp_lcm::identity>(sequence, now);
    type.model_hash = static_cast<std::int64_t>(message.model_hash);
    type.wrench_frame = static_cast<std::int8_t>(message.wrench_frame);
    return event(type);
  }

  LcmEvent operator()(const MeasuredJointsMessage& message) const {
    auto type = stamped<flexcomp_lcm::measured_joints>(sequence, now);
    std::copy(message.q.begin(), message.q.end(), type.position);
    return event(type);
  }

  LcmEvent operator()(const MeasuredPositionMessage& message) const {
    auto type = stamped<flexcomp_lcm::measured_position>(sequence, now);
    std::copy(message.position.begin(), message.position.end(), type.position);
    return event(type);
  }

  LcmEvent operator()(const HeartbeatMessage& message) const {
    auto type = stamped<flexcomp_lcm::heartbeat>(sequence, now);
    type.uptime = message.uptime;
    type.state = static_cast<std::int8_t>(message.state);
    type.slot = static_cast<std::int8_t>(message.slot);
    type.table_result = message.table_result;
    type.latched_faults = message.latched_faults;
    type.node_latched_faults = message.node_latched_faults;
    type.table_model_hash = static_cast<std::int64_t>(message.table_model_hash);
    type.largest_gain = message.largest_gain;
    return event(type);
  }

  LcmEvent operator()(const FaultMessage& message) const {
    auto type = stamped<flexcomp_lcm::fault>(sequence, now);
    type.code = message.code;
    type.active = message.active ? 1 : 0;
    type.detail = message.detail;
    return event(type);
  }

  LcmEvent operator()(const StatisticMessage& message) const {
    auto type = stamped<flexcomp_lcm::statistic>(sequence, now);
    type.name = message.name;
    type.value = static_cast<std::int64_t>(message.value);
    return event(type);
  }

  LcmEvent operator()(const TransferBeginMessage& message) const {
    auto type = stamped<flexcomp_lcm::table_begin>(sequence, now);
    type.size = message.size;
    type.crc = message.crc;
    return event(type);
  }

  LcmEvent operator()(const TransferDataMessage& message) const {
    auto type = stamped<flexcomp_lcm::table_data>(sequence, now);
    type.word_index = message.word_index;
    type.count = static_cast<std::int8_t>(message.count);
    std::transform(message.words.begin(), message.words.end(), type.words,
                   [](std::uint32_t word) { return static_cast<std::int32_t>(word); });
    return event(type);
  }

  LcmEvent operator()(const TransferEndMessage& message) const {
    auto type = stamped<flexcomp_lcm::table_end>(sequence, now);
    type.crc = message.crc;
    return event(type);
  }

  LcmEvent operator()(const TransferReplyMessage& message) const {
    auto type = stamped<flexcomp_lcm::table_reply>(sequence, now);
    type.stage = static_cast<std::int8_t>(message.stage);
    type.result = message.result;
    type.words = message.words;
    return event(type);
  }
};

std::array<double, 6> six(const double* values) {
  std::array<double, 6> copy{};
  std::copy_n(values, copy.size(), copy.begin());
  return copy;
}

Message to_message(const flexcomp_lcm::joint_setpoint& type) {
  return SetpointMessage{type.timestamp, six(type.position)};
}

Message to_message(const flexcomp_lcm::wrench& type) {
  WrenchMessage message{type.timestamp, {}, type.saturated != 0};
  std::copy_n(type.force, 3, message.wrench.begin());
  std::copy_n(type.moment, 3, message.wrench.begin() + 3);
  return message;
}

Message to_message(const flexcomp_lcm::corrected_setpoint& type) {
  return CorrectedMessage{type.setpoint_timestamp,
                          six(type.corrected),
                          six(type.uncorrected),
                          static_cast<std::uint32_t>(type.status),
                          static_cast<std::uint16_t>(type.node_status),
                          static_cast<std::uint8_t>(type.state)};
}

Message to_message(const flexcomp_lcm::command& type) {
  return CommandMessage{static_cast<Command>(type.command)};
}

Message to_message(const flexcomp_lcm::command_reply& type) {
  return CommandReplyMessage{static_cast<Command>(type.command),
                             static_cast<std::uint8_t>(type.reply), type.largest_gain};
}

Message to_message(const flexcomp_lcm::identity& type) {
  return IdentityMessage{static_cast<std::uint64_t>(type.model_hash),
                         static_cast<WrenchFrame>(type.wrench_frame)};
}

Message to_message(const flexcomp_lcm::measured_joints& type) {
  return MeasuredJointsMessage{six(type.position)};
}

Message to_message(const flexcomp_lcm::measured_position& type) {
  return MeasuredPositionMessage{{type.position[0], type.position[1], type.position[2]}};
}

Message to_message(const flexcomp_lcm::heartbeat& type) {
  return HeartbeatMessage{static_cast<std::uint32_t>(type.uptime),
                          static_cast<std::uint8_t>(type.state),
                          static_cast<std::uint8_t>(type.slot),
                          static_cast<std::uint8_t>(type.table_result),
                          static_cast<std::uint32_t>(type.latched_faults),
                          static_cast<std::uint16_t>(type.node_latched_faults),
                          static_cast<std::uint64_t>(type.table_model_hash),
                          type.largest_gain};
}

Message to_message(const flexcomp_lcm::fault& type) {
  return FaultMessage{static_cast<std::uint16_t>(type.code), type.active != 0,
                      static_cast<std::uint32_t>(type.detail)};
}

Message to_message(const flexcomp_lcm::statistic& type) {
  return StatisticMessage{static_cast<std::uint8_t>(type.name),
                          static_cast<std::uint64_t>(type.value)};
}

Message to_message(const flexcomp_lcm::table_begin& type) {
  return TransferBeginMessage{static_cast<std::uint32_t>(type.size),
                              static_cast<std::uint32_t>(type.crc)};
}

Message to_message(const flexcomp_lcm::table_data& type) {
  TransferDataMessage message{
      static_cast<std::uint32_t>(type.word_index), static_cast<std::uint32_t>(type.count), {}};
  std::transform(std::begin(type.words), std::end(type.words), message.words.begin(),
                 [](std::int32_t word) { return static_cast<std::uint32_t>(word); });
  return message;
}

Message to_message(const flexcomp_lcm::table_end& type) {
  return TransferEndMessage{static_cast<std::uint32_t>(type.crc)};
}

Message to_message(const flexcomp_lcm::table_reply& type) {
  return TransferReplyMessage{static_cast<TransferStage>(type.stage),
                              static_cast<std::uint8_t>(type.result),
                              static_cast<std::uint32_t>(type.words)};
}

/// Decodes into `result` if the channel is that of `Type`.
template <typename Type>
bool try_decode(const std::string& channel, const void* data, std::size_t size,
                LcmMessage* result) {
  if (channel != kChannel<Type>) {
    return false;
  }
  Type type{};
  if (type.decode(data, 0, static_cast<int>(size)) >= 0) {
    *result = {to_message(type), type.sequence, type.timestamp};
  }
  return true;
}

template <typename... Types>
LcmMessage decode_any(const std::string& channel, const void* data, std::size_t size) {
  LcmMessage result;
  (try_decode<Types>(channel, data, size, &result) || ...);
  return result;
}

}  // namespace

LcmEvent encode_lcm(const Message& message, std::int64_t sequence, std::int64_t now) {
  return std::visit(Encoder{sequence, now}, message);
}

LcmMessage decode_lcm(const std::string& channel, const void* data, std::size_t size) {
  using namespace flexcomp_lcm;
  return decode_any<joint_setpoint, wrench, corrected_setpoint, command, command_reply, identity,
                    measured_joints, measured_position, heartbeat, fault, statistic, table_begin,
                    table_data, table_end, table_reply>(channel, data, size);
}

}  // namespace flexcomp
