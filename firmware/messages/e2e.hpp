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

/// A table of `Word`'s CRC, most significant bit first: what a byte comes to.
template <typename Word, unsigned Polynomial>
constexpr std::array<Word, 256> make_crc_table() {
  constexpr unsigned kBits = 8 * sizeof(Word);
  std::array<Word, 256> table{};
  for (unsigned byte = 0; byte < 256; ++byte) {
    unsigned crc = byte << (kBits - 8);
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc & (1U << (kBits - 1))) != 0 ? (crc << 1) ^ Polynomial : crc << 1;
    }
    table[byte] = static_cast<Word>(crc);
  }
  return table;
}

inline constexpr std::array<std::uint8_t, 256> kCrc8 = make_crc_table<std::uint8_t, 0x2F>();

/// The CRC-8 of a classic frame's data identifier, which its payload goes on from.
constexpr std::uint8_t crc8_of_identifier(std::uint32_t id) {
  const std::uint8_t low = kCrc8[0xFFU ^ (id & 0xFFU)];
  return kCrc8[low ^ (id >> 8 & 0xFFU)];
}

/// The checksum of a classic frame of 8 bytes, as nearly all are, given as two words.
inline std::uint8_t classic_checksum(std::uint8_t crc_of_identifier, std::uint32_t first,
                                     std::uint32_t second) {
  std::uint32_t crc = kCrc8[crc_of_identifier ^ (first >> 8 & 0xFFU)];
  crc = kCrc8[crc ^ (first >> 16 & 0xFFU)];
  crc = kCrc8[crc ^ first >> 24];
  crc = kCrc8[(crc ^ second) & 0xFFU];
  crc = kCrc8[crc ^ (second >> 8 & 0xFFU)];
  crc = kCrc8[crc ^ (second >> 16 & 0xFFU)];
  return static_cast<std::uint8_t>(~kCrc8[crc ^ second >> 24]);
}
/// Does it fit the frame's first byte, which it stands in?
inline bool is_classic_intact(std::uint8_t crc_of_identifier, const std::uint8_t* data) {
  std::uint8_t crc = crc_of_identifier;
#pragma GCC unroll 7
  for (std::size_t i = 1; i < 8; ++i) {
    crc = kCrc8[crc ^ data[i]];
  }
  return (crc ^ data[0]) == 0xFF;  // a checksum is the CRC inverted
}

}  // namespace flexcomp
