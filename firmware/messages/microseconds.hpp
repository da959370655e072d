#pragma once

#include <cstdint>

namespace flexcomp {

/// The low 32 bits of a time (ns) in µs, rounded towards zero. By 32-bit divisions: processors
/// without 64-bit ones need a library for them, which takes long.
inline std::uint32_t low_microseconds(std::int64_t nanoseconds) {
  constexpr std::uint32_t kMicrosecond = 1000;
  if (nanoseconds < 0) {
    return static_cast<std::uint32_t>(nanoseconds / kMicrosecond);
  }
  // As on paper, with digits of 16 bits; those of the upper half count for what is left of them.
  const auto high = static_cast<std::uint32_t>(nanoseconds >> 32);
  const auto low = static_cast<std::uint32_t>(nanoseconds & 0xFFFFFFFF);
  const std::uint32_t upper = (high % kMicrosecond) << 16 | low >> 16;
  const std::uint32_t lower = (upper % kMicrosecond) << 16 | (low & 0xFFFFU);
  return (upper / kMicrosecond) << 16 | lower / kMicrosecond;
}

}  // namespace flexcomp
