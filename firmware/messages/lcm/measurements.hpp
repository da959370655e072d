#pragma once

#include "flexcomp_lcm/measured_joints.hpp"
#include "flexcomp_lcm/measured_position.hpp"
#include "flexcomp_lcm/wrench.hpp"
#include "messages/lcm/event.hpp"

/// Measurements of sensors and trackers, on LCM.
namespace flexcomp::lcm {

template <>
struct Event<WrenchMessage> {
  using Type = flexcomp_lcm::wrench;

  static void write(const WrenchMessage& message, Type* type) {
    std::copy_n(message.wrench.begin(), 3, type->force);
    std::copy_n(message.wrench.begin() + 3, 3, type->moment);
    type->saturated = message.saturated ? 1 : 0;
  }

  static WrenchMessage read(const Type& type) {
    WrenchMessage message{type.timestamp, {}, type.saturated != 0};
    std::copy_n(type.force, 3, message.wrench.begin());
    std::copy_n(type.moment, 3, message.wrench.begin() + 3);
    return message;
  }
};

template <>
struct Event<MeasuredJointsMessage> {
  using Type = flexcomp_lcm::measured_joints;

  static void write(const MeasuredJointsMessage& message, Type* type) {
    std::copy(message.q.begin(), message.q.end(), type->position);
  }

  static MeasuredJointsMessage read(const Type& type) { return {six(type.position)}; }
};

template <>
struct Event<MeasuredPositionMessage> {
  using Type = flexcomp_lcm::measured_position;

  static void write(const MeasuredPositionMessage& message, Type* type) {
    std::copy(message.position.begin(), message.position.end(), type->position);
  }

  static MeasuredPositionMessage read(const Type& type) {
    return {{type.position[0], type.position[1], type.position[2]}};
  }
};

}  // namespace flexcomp::lcm
