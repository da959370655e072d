#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "messages/messages.hpp"

namespace flexcomp {

/// A message as it travels on LCM, through the classes generated from lcm/*.lcm. Allocates: not for
/// the real-time thread.
struct LcmEvent {
  std::string channel;  ///< "FLEXCOMP_" and the type's name in capitals
  std::vector<std::uint8_t> data;
};

/// Every channel of ours, as a regular expression for lcm_subscribe.
constexpr const char* kLcmChannels = "FLEXCOMP_.*";

/// Encodes a message with its sender's sequence number and monotonic time (ns).
LcmEvent encode_lcm(const Message& message, std::int64_t sequence, std::int64_t now);

struct LcmMessage {
  Message message;  ///< std::monostate if the channel or the type is not ours, or the data damaged
  std::int64_t sequence = 0;
  std::int64_t timestamp = 0;  ///< ns, sender's clock
};

LcmMessage decode_lcm(const std::string& channel, const void* data, std::size_t size);

}  // namespace flexcomp
