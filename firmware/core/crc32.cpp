#include "crc32.hpp"

#include <array>

namespace flexcomp {
namespace {

/// One entry a nibble: 64 bytes of flash instead of 1 KiB, and tables are checked once, not a tick.
constexpr std::array<std::uint32_t, 16> make_nibble_table() {
  std::array<std::uint32_t, 16> table{};
  for (std::uint32_t nibble = 0; nibble < 16; ++nibble) {
    std::uint32_t crc = nibble;
    for (int bit = 0; bit < 4; ++bit) {
      crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
    table[nibble] = crc;
  }
  return table;
}

constexpr std::array<std::uint32_t, 16> kNibbles = make_nibble_table();

}  // namespace

std::uint32_t crc32(const void* data, std::size_t size, std::uint32_t crc) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  crc = ~crc;
  for (std::size_t i = 0; i < size; ++i) {
    crc ^= bytes[i];
    crc = (crc >> 4) ^ kNibbles[crc & 15U];
    crc = (crc >> 4) ^ kNibbles[crc & 15U];
  }
  return ~crc;
}

}  // namespace flexcomp
