#pragma once

#include <cstddef>
#include <cstdint>

namespace flexcomp {

/// CRC-32 of IEEE 802.3 (reflected polynomial 0xEDB88320) over `size` bytes, continued from `crc`
/// (0 to begin with).
std::uint32_t crc32(const void* data, std::size_t size, std::uint32_t crc = 0);

}  // namespace flexcomp
