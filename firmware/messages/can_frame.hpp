#pragma once

#include <array>
#include <cstdint>

namespace flexcomp {

/// One CAN frame with an 11-bit identifier, classic (up to 8 bytes) or FD (up to 64).
struct CanFrame {
  std::uint32_t id = 0;
  std::uint8_t size = 0;  ///< bytes of data
  bool fd = false;
  alignas(std::uint32_t) std::array<std::uint8_t, 64> data{};
};

}  // namespace flexcomp
