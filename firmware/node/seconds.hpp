#pragma once

#include <cstdint>

namespace flexcomp {

/// Nanoseconds as seconds, to float's precision; beyond ±39 h the nearest of those. By 32-bit
/// conversions: processors without 64-bit ones need a library for them, which takes long.
inline float seconds(std::int64_t nanoseconds) {
  constexpr std::int64_t kMost = std::int64_t{0x7FFFFFFF} << 16;
  const auto beyond = static_cast<std::int32_t>(nanoseconds >> 47);  // 0 or -1: it is not
  const std::int64_t limited =
      beyond == 0 || beyond == -1 ? nanoseconds : (nanoseconds > 0 ? kMost : -kMost);
  const auto high = static_cast<float>(static_cast<std::int32_t>(limited >> 16));
  const auto low = static_cast<float>(static_cast<std::int32_t>(limited & 0xFFFF));
  return 65536e-9F * high + 1e-9F * low;
}

}  // namespace flexcomp
