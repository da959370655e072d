#pragma once

#include <array>
#include <cstdint>

namespace flexcomp {

/// A secret that all who authenticate to each other hold; 128 bits.
using AuthenticationKey = std::array<std::uint8_t, 16>;

}  // namespace flexcomp
