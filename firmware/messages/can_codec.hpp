#pragma once

#include <array>

#include "messages/can_layout.hpp"
#include "messages/messages.hpp"

namespace flexcomp {

/// Between messages and the payloads of frames, through the codec generated from flexcomp.dbc.
/// Checksums and counters are not its business.

using ClassicPayload = std::array<std::uint8_t, 8>;
using FramePayloads = std::array<ClassicPayload, kMaxFrameParts>;

/// Unpacks a message of one frame; std::monostate for an identifier that is not one.
Message unpack_message(std::uint32_t id, const std::uint8_t* data);

/// Unpacks a set of classic frames.
Message unpack_set(FrameGroup group, const FramePayloads& parts);

}  // namespace flexcomp
