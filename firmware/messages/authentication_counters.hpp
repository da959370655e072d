#pragma once

#include <cstdint>

namespace flexcomp {

/// Messages that were refused because a key is configured.
struct AuthenticationCounters {
  bool has_key = false;
  std::uint32_t forged = 0;           ///< the code does not fit
  std::uint32_t not_fresh = 0;        ///< replayed, held back, or the clocks disagree
  std::uint32_t unauthenticated = 0;  ///< given up: no authentication, or a part is missing
};

}  // namespace flexcomp
