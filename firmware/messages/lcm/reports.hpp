#pragma once

#include "flexcomp_lcm/fault.hpp"
#include "flexcomp_lcm/heartbeat.hpp"
#include "flexcomp_lcm/statistic.hpp"
#include "messages/lcm/event.hpp"

/// Reports of the node on itself, on LCM.
namespace flexcomp::lcm {

template <>
struct Event<HeartbeatMessage> {
  using Type = flexcomp_lcm::heartbeat;

  static void write(const HeartbeatMessage& message, Type* type) {
    type->uptime = message.uptime;
    type->state = static_cast<std::int8_t>(message.state);
    type->slot = static_cast<std::int8_t>(message.slot);
    type->table_result = message.table_result;
    type->latched_faults = message.latched_faults;
    type->node_latched_faults = message.node_latched_faults;
    type->table_model_hash = static_cast<std::int64_t>(message.table_model_hash);
    type->largest_gain = message.largest_gain;
  }

  static HeartbeatMessage read(const Type& type) {
    return {static_cast<std::uint32_t>(type.uptime),
            static_cast<std::uint8_t>(type.state),
            static_cast<std::uint8_t>(type.slot),
            static_cast<std::uint8_t>(type.table_result),
            static_cast<std::uint32_t>(type.latched_faults),
            static_cast<std::uint16_t>(type.node_latched_faults),
            static_cast<std::uint64_t>(type.table_model_hash),
            type.largest_gain};
  }
};

template <>
struct Event<FaultMessage> {
  using Type = flexcomp_lcm::fault;

  static void write(const FaultMessage& message, Type* type) {
    type->code = message.code;
    type->active = message.active ? 1 : 0;
    type->detail = message.detail;
  }

  static FaultMessage read(const Type& type) {
    return {static_cast<std::uint16_t>(type.code), type.active != 0,
            static_cast<std::uint32_t>(type.detail)};
  }
};

template <>
struct Event<StatisticMessage> {
  using Type = flexcomp_lcm::statistic;

  static void write(const StatisticMessage& message, Type* type) {
    type->name = message.name;
    type->value = static_cast<std::int64_t>(message.value);
  }

  static StatisticMessage read(const Type& type) {
    return {static_cast<std::uint8_t>(type.name), static_cast<std::uint64_t>(type.value)};
  }
};

}  // namespace flexcomp::lcm
