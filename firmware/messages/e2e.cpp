#include "messages/e2e.hpp"

#include <cstring>

namespace flexcomp {
namespace {

constexpr std::size_t kClassicChecksumBytes = 1;
constexpr std::size_t kFdChecksumBytes = 2;

using Crc16Tables = std::array<std::array<std::uint16_t, 256>, 4>;

std::uint8_t checksum_of_classic(const CanFrame& frame) {
  std::uint8_t crc = crc8_of_identifier(frame.id);
  for (std::size_t i = kClassicChecksumBytes; i < frame.size; ++i) {
    crc = kCrc8[crc ^ frame.data[i]];
  }
  return static_cast<std::uint8_t>(~crc);
}

constexpr std::uint16_t swapped(unsigned value) {
  return static_cast<std::uint16_t>((value & 0xFFU) << 8 | (value >> 8 & 0xFFU));
}

/// Table k holds what a byte comes to, k bytes later; the byte that the CRC goes on with lowest, as
/// it is in a word.
constexpr Crc16Tables make_crc16_tables() {
  constexpr std::array<std::uint16_t, 256> kOneByte = make_crc_table<std::uint16_t, 0x1021>();
  Crc16Tables tables{};
  for (std::size_t byte = 0; byte < 256; ++byte) {
    unsigned crc = kOneByte[byte];
    for (auto& table : tables) {
      table[byte] = swapped(crc);
      crc = (crc << 8 & 0xFFFFU) ^ kOneByte[crc >> 8];
    }
  }
  return tables;
}

constexpr Crc16Tables kCrc16 = make_crc16_tables();

std::uint32_t step(std::uint32_t crc, unsigned byte) {
  return crc >> 8 ^ kCrc16[0][(crc ^ byte) & 0xFFU];
}

/// Four bytes at once (slicing-by-4, as in core/crc32.cpp).
std::uint32_t step_by_word(std::uint32_t crc, std::uint32_t word) {
  word ^= crc;
  return std::uint32_t{kCrc16[3][word & 0xFFU]} ^ kCrc16[2][word >> 8 & 0xFFU] ^
         kCrc16[1][word >> 16 & 0xFFU] ^ kCrc16[0][word >> 24];
}

/// The identifier stands in the place of the checksum: it comes first, and is as long.
std::uint16_t checksum_of_fd(const CanFrame& frame) {
  std::uint32_t crc = 0xFFFF;
  std::uint32_t word = 0;
  std::size_t at = 0;
  if (frame.size < sizeof word) {
    crc = step(step(crc, frame.id & 0xFFU), frame.id >> 8);
    at = kFdChecksumBytes;
  }
  for (; at + sizeof word <= frame.size; at += sizeof word) {
    std::memcpy(&word, frame.data.data() + at, sizeof word);
    crc = step_by_word(crc, at == 0 ? (word & 0xFFFF0000U) | frame.id : word);
  }
  for (; at < frame.size; ++at) {
    crc = step(crc, frame.data[at]);
  }
  return swapped(crc);
}

}  // namespace

void protect(CanFrame* frame) {
  if (frame->fd) {
    const std::uint16_t crc = checksum_of_fd(*frame);
    frame->data[0] = static_cast<std::uint8_t>(crc & 0xFFU);
    frame->data[1] = static_cast<std::uint8_t>(crc >> 8);
  } else {
    frame->data[0] = checksum_of_classic(*frame);
  }
}

bool is_intact(const CanFrame& frame) {
  if (frame.size > frame.data.size() || frame.id > 0x7FFU) {
    return false;
  }
  if (frame.fd) {
    return frame.size > kFdChecksumBytes &&
           (frame.data[0] | frame.data[1] << 8) == checksum_of_fd(frame);
  }
  if (frame.size == 8) {
    return is_classic_intact(crc8_of_identifier(frame.id), frame.data.data());
  }
  return frame.size > kClassicChecksumBytes && frame.size < 8 &&
         frame.data[0] == checksum_of_classic(frame);
}

}  // namespace flexcomp
