#pragma once

#include <cstdint>

namespace flexcomp {

/// Age of messages that carry their sender's clock, which nobody has set to ours.
///
/// The shortest way a message ever took, as told by both clocks, counts as no delay; a message that
/// took longer is older by the difference. The reference follows clocks that drift apart by up to
/// 100 ppm. Clocks may wrap at 2³² µs.
class TransportDelay {
 public:
  /// Delay (ns) of a message that was sent at `timestamp` and received at `now`; 0 for kNoTime.
  std::int64_t observe(std::int64_t timestamp, std::int64_t now);

 private:
  bool started_ = false;
  std::uint32_t reference_ = 0;  ///< µs, shortest difference of the clocks
  std::int64_t allowance_ = 0;   ///< ns of drift not yet given to the reference
  std::int64_t observed_at_ = 0;
};

}  // namespace flexcomp
