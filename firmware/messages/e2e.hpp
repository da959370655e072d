#pragma once

#include "messages/can_frame.hpp"

namespace flexcomp {

/// End-to-end protection of a frame, after AUTOSAR's E2E profiles 2 and 5: a checksum over the
/// frame's data identifier and payload, so that damage and a frame under another's identifier are
/// both seen. The counter that shows loss and repetition is part of the payload.
///
/// Classic frames carry CRC-8 (polynomial 0x2F) in byte 0, FD frames CRC-16 (polynomial 0x1021) in
/// bytes 0 and 1, low byte first. The data identifier is the CAN identifier. It finds every single
/// and double bit error; it is no authentication.

/// Writes the checksum of a frame that is complete but for it. Needs at least 2 (FD: 3) bytes.
void protect(CanFrame* frame);

/// Does the checksum fit? Also false for a frame too short to hold one or longer than 64 bytes.
bool is_intact(const CanFrame& frame);

/// The counter of a frame that is intact: 4 bits, of an FD frame 8.
inline std::uint32_t counter_of(const CanFrame& frame) {
  return frame.fd ? frame.data[2] : frame.data[1] & 0x0FU;
}

}  // namespace flexcomp
