#include "crc32.hpp"

#include <array>
#include <cstring>

namespace flexcomp {
namespace {

using Tables = std::array<std::array<std::uint32_t, 256>, 4>;

/// Table k holds what a byte comes to, k bytes later.
constexpr Tables make_tables() {
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
    tables[0][byte] = crc;
  }
  for (std::size_t later = 1; later < tables.size(); ++later) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t crc = tables[later - 1][byte];
      tables[later][byte] = (crc >> 8) ^ tables[0][crc & 0xFFU];
    }
  }
  return tables;
}

constexpr Tables kTables = make_tables();

}  // namespace

/// Four bytes at once (slicing-by-4: Kounavis and Berry, A systematic approach to building high
/// performance software-based CRC generators, ISCC 2005).
std::uint32_t crc32(const void* data, std::size_t size, std::uint32_t crc) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  crc = ~crc;
  for (; size >= sizeof(std::uint32_t); size -= sizeof(std::uint32_t)) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes, sizeof word);  // little-endian, as tables are
    crc ^= word;
    crc = kTables[3][crc & 0xFFU] ^ kTables[2][(crc >> 8) & 0xFFU] ^
          kTables[1][(crc >> 16) & 0xFFU] ^ kTables[0][crc >> 24];
    bytes += sizeof word;
  }
  for (; size > 0; --size) {
    crc = (crc >> 8) ^ kTables[0][(crc ^ *bytes++) & 0xFFU];
  }
  return ~crc;
}

}  // namespace flexcomp
