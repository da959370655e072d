#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace flexcomp {

/// The bytes behind a signed table, in the same file and transfer; little-endian. The table before
/// it is as it would be without.
struct TableTrailer {
  std::uint32_t magic;              ///< kTableTrailerMagic
  std::uint32_t counter;            ///< the table's version, as who signs it counts
  std::array<std::uint8_t, 16> tag; /**< AES-128-CMAC (RFC 4493) of all before it: the table, magic
                                         number and counter */
};
static_assert(sizeof(TableTrailer) == 24, "written to files: no padding");

constexpr std::uint32_t kTableTrailerMagic = 0x31534346;  // "FCS1"

/// Bytes of the table itself where `size` bytes are given that begin with one: less a trailer, if
/// there is one. Says nothing of whether either is good.
inline std::size_t bytes_of_table(const void* data, std::size_t size) {
  constexpr std::size_t kSizePlace = 8;  // TableHeader::size
  constexpr std::size_t kLeast = kSizePlace + sizeof(std::uint32_t) + sizeof(TableTrailer);
  if (data == nullptr || size < kLeast) {
    return size;
  }
  const std::size_t before = size - sizeof(TableTrailer);
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::uint32_t stated = 0;
  std::uint32_t magic = 0;
  std::memcpy(&stated, bytes + kSizePlace, sizeof stated);
  std::memcpy(&magic, bytes + before, sizeof magic);
  return stated == before && magic == kTableTrailerMagic ? before : size;
}

}  // namespace flexcomp
