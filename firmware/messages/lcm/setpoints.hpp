#pragma once

#include "flexcomp_lcm/corrected_setpoint.hpp"
#include "flexcomp_lcm/joint_setpoint.hpp"
#include "messages/lcm/event.hpp"

/// Setpoint and corrected setpoint on LCM.
namespace flexcomp::lcm {

template <>
struct Event<SetpointMessage> {
  using Type = flexcomp_lcm::joint_setpoint;

  static void write(const SetpointMessage& message, Type* type) {
    std::copy(message.q.begin(), message.q.end(), type->position);
  }

  static SetpointMessage read(const Type& type) { return {type.timestamp, six(type.position)}; }
};

template <>
struct Event<CorrectedMessage> {
  using Type = flexcomp_lcm::corrected_setpoint;

  static void write(const CorrectedMessage& message, Type* type) {
    type->setpoint_timestamp = message.timestamp;
    std::copy(message.corrected.begin(), message.corrected.end(), type->corrected);
    std::copy(message.uncorrected.begin(), message.uncorrected.end(), type->uncorrected);
    type->status = message.status;
    type->node_status = message.node_status;
    type->state = static_cast<std::int8_t>(message.state);
  }

  static CorrectedMessage read(const Type& type) {
    return {type.setpoint_timestamp,
            six(type.corrected),
            six(type.uncorrected),
            static_cast<std::uint32_t>(type.status),
            static_cast<std::uint16_t>(type.node_status),
            static_cast<std::uint8_t>(type.state)};
  }
};

}  // namespace flexcomp::lcm
