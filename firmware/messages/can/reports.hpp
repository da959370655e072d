#pragma once

#include "messages/can/frame_set.hpp"

/// Reports of the node on itself, on CAN.
namespace flexcomp::can {

template <>
struct Classic<HeartbeatMessage>
    : FrameSet<DBC_FRAME(HEARTBEAT, heartbeat), DBC_FRAME(LATCHED, latched),
               DBC_FRAME(TABLE_LOW, table_low), DBC_FRAME(TABLE_HIGH, table_high)> {
  using LargestGain = DBC_SIGNAL(table_low, largest_gain, 16);

  static void pack(const HeartbeatMessage& message, flexcomp_can_heartbeat_t* heartbeat,
                   flexcomp_can_latched_t* latched, flexcomp_can_table_low_t* low,
                   flexcomp_can_table_high_t* high) {
    heartbeat->uptime = message.uptime;
    heartbeat->state = message.state;
    heartbeat->slot = message.slot;
    heartbeat->table_result = message.table_result;
    latched->latched_faults = message.latched_faults;
    latched->node_latched_faults = message.node_latched_faults;
    low->model_hash_low = low_word(message.table_model_hash);
    low->largest_gain = LargestGain::raw(message.largest_gain);
    high->model_hash_high = high_word(message.table_model_hash);
  }

  static HeartbeatMessage unpack(const flexcomp_can_heartbeat_t& heartbeat,
                                 const flexcomp_can_latched_t& latched,
                                 const flexcomp_can_table_low_t& low,
                                 const flexcomp_can_table_high_t& high) {
    return {heartbeat.uptime,
            heartbeat.state,
            heartbeat.slot,
            heartbeat.table_result,
            latched.latched_faults,
            latched.node_latched_faults,
            joined(low.model_hash_low, high.model_hash_high),
            LargestGain::value(low.largest_gain)};
  }
};

template <>
struct Classic<FaultMessage> : FrameSet<DBC_FRAME(FAULT, fault)> {
  static void pack(const FaultMessage& message, flexcomp_can_fault_t* raw) {
    raw->code = message.code;
    raw->active = message.active ? 1 : 0;
    raw->detail = message.detail;
  }

  static FaultMessage unpack(const flexcomp_can_fault_t& raw) {
    return {raw.code, raw.active != 0, raw.detail};
  }
};

template <>
struct Classic<StatisticMessage> : FrameSet<DBC_FRAME(STATISTIC, statistic)> {
  static void pack(const StatisticMessage& message, flexcomp_can_statistic_t* raw) {
    raw->name = message.name;
    raw->value = message.value;
  }

  static StatisticMessage unpack(const flexcomp_can_statistic_t& raw) {
    return {raw.name, raw.value};
  }
};

}  // namespace flexcomp::can
