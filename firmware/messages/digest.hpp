#pragma once

#include <cstdint>
#include <string_view>

namespace flexcomp {

/// FNV-1a: tells contents apart, no more.
inline std::uint32_t digest(std::string_view bytes) {
  std::uint32_t hash = 2166136261U;
  for (const char c : bytes) {
    hash = (hash ^ static_cast<std::uint8_t>(c)) * 16777619U;
  }
  return hash;
}

}  // namespace flexcomp
