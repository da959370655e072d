#pragma once

#include <array>
#include <cstdint>

#include "messages/authentication_counters.hpp"

namespace flexcomp {

/// Tells from the counters when messages are being refused under a key: from the first one until
/// there was none for a second.
class RefusalWatch {
 public:
  /// Bit 0: forged, bit 1: not fresh, bit 2: without authentication; none without a key. `now` in
  /// ns; to be called every tick.
  std::uint32_t observe(const AuthenticationCounters& counters, std::int64_t now) {
    if (!counters.has_key) {
      return 0;
    }
    const std::array<std::uint32_t, 3> counts = {counters.forged, counters.not_fresh,
                                                 counters.unauthenticated};
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const std::uint32_t bit = 1U << i;
      if (counts[i] != before_[i]) {
        before_[i] = counts[i];
        refused_at_[i] = now;
        bits_ |= bit;
      } else if (now - refused_at_[i] > kQuiet) {
        bits_ &= ~bit;
      }
    }
    return bits_;
  }

 private:
  static constexpr std::int64_t kQuiet = 1'000'000'000;  // ns

  std::array<std::uint32_t, 3> before_{};
  std::array<std::int64_t, 3> refused_at_{};
  std::uint32_t bits_ = 0;
};

}  // namespace flexcomp
