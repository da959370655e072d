#pragma once

#include <cstdint>

namespace flexcomp::cortex_m7 {

/// A register of the processor or of its peripherals, by its address.
inline volatile std::uint32_t& register_at(std::uint32_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}

}  // namespace flexcomp::cortex_m7
