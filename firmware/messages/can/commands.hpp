#pragma once

#include "messages/can/frame_set.hpp"

/// Commands, their replies, and who gives them, on CAN.
namespace flexcomp::can {

template <>
struct Classic<CommandMessage> : FrameSet<DBC_FRAME(COMMAND, command)> {
  using Authentication = DBC_FRAME(COMMAND_AUTHENTICATION, command_authentication);
  static constexpr bool kMayRestart = true;

  static void pack(const CommandMessage& message, flexcomp_can_command_t* raw) {
    raw->command = static_cast<std::uint8_t>(message.command);
  }

  static CommandMessage unpack(const flexcomp_can_command_t& raw) {
    return {static_cast<Command>(raw.command)};
  }
};

template <>
struct Classic<CommandReplyMessage> : FrameSet<DBC_FRAME(COMMAND_REPLY, command_reply)> {
  using LargestGain = DBC_SIGNAL(command_reply, largest_gain, 16);

  static void pack(const CommandReplyMessage& message, flexcomp_can_command_reply_t* raw) {
    raw->command = static_cast<std::uint8_t>(message.command);
    raw->reply = message.reply;
    raw->largest_gain = LargestGain::raw(message.largest_gain);
  }

  static CommandReplyMessage unpack(const flexcomp_can_command_reply_t& raw) {
    return {static_cast<Command>(raw.command), raw.reply, LargestGain::value(raw.largest_gain)};
  }
};

template <>
struct Classic<IdentityMessage>
    : FrameSet<DBC_FRAME(IDENTITY_LOW, identity_low), DBC_FRAME(IDENTITY_HIGH, identity_high)> {
  using Authentication = DBC_FRAME(IDENTITY_AUTHENTICATION, identity_authentication);

  static void pack(const IdentityMessage& message, flexcomp_can_identity_low_t* low,
                   flexcomp_can_identity_high_t* high) {
    low->model_hash_low = low_word(message.model_hash);
    low->wrench_frame = static_cast<std::uint8_t>(message.wrench_frame) & 0x0FU;
    high->model_hash_high = high_word(message.model_hash);
  }

  static IdentityMessage unpack(const flexcomp_can_identity_low_t& low,
                                const flexcomp_can_identity_high_t& high) {
    return {joined(low.model_hash_low, high.model_hash_high),
            static_cast<WrenchFrame>(low.wrench_frame)};
  }
};

}  // namespace flexcomp::can
