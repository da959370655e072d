#pragma once

#include "flexcomp_lcm/command.hpp"
#include "flexcomp_lcm/command_reply.hpp"
#include "flexcomp_lcm/identity.hpp"
#include "messages/lcm/event.hpp"

/// Commands, their replies, and who gives them, on LCM.
namespace flexcomp::lcm {

template <>
struct Event<CommandMessage> {
  using Type = flexcomp_lcm::command;

  static void write(const CommandMessage& message, Type* type) {
    type->command = static_cast<std::int8_t>(message.command);
  }

  static CommandMessage read(const Type& type) { return {static_cast<Command>(type.command)}; }
};

template <>
struct Event<CommandReplyMessage> {
  using Type = flexcomp_lcm::command_reply;

  static void write(const CommandReplyMessage& message, Type* type) {
    type->command = static_cast<std::int8_t>(message.command);
    type->reply = message.reply;
    type->largest_gain = message.largest_gain;
  }

  static CommandReplyMessage read(const Type& type) {
    return {static_cast<Command>(type.command), static_cast<std::uint8_t>(type.reply),
            type.largest_gain};
  }
};

template <>
struct Event<IdentityMessage> {
  using Type = flexcomp_lcm::identity;

  static void write(const IdentityMessage& message, Type* type) {
    type->model_hash = static_cast<std::int64_t>(message.model_hash);
    type->wrench_frame = static_cast<std::int8_t>(message.wrench_frame);
  }

  static IdentityMessage read(const Type& type) {
    return {static_cast<std::uint64_t>(type.model_hash),
            static_cast<WrenchFrame>(type.wrench_frame)};
  }
};

}  // namespace flexcomp::lcm
