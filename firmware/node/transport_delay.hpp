#pragma once

#include <cstdint>

namespace flexcomp {

/// Age of messages that carry their sender's clock, which nobody has set to ours.
///
/// The usual shortest way of messages, as told by both clocks, counts as no delay; a message that
/// took longer is older by the difference. That reference follows clocks that drift apart by up to
/// 100 ppm. Clocks may wrap at 2^32 µs.
///
/// One message never moves the reference (as in PX4's Timesync): its clock may be wrong. Messages
/// in a row that agree with each other do:
/// - four that came by a shorter way: the sender's clock was put forward, or the way until then was
///   the longer one;
/// - those of a whole second, sixteen at least, that are later by the same time: the sender's clock
///   began anew or was put back. Until then they are old, as those of a stream that is held up are.
class TransportDelay {
 public:
  /// Delay (ns) of a message that was sent at `timestamp` and received at `now`; 0 for kNoTime.
  std::int64_t observe(std::int64_t timestamp, std::int64_t now);

 private:
  void follow_drift(std::int64_t now);
  bool agrees(std::uint32_t difference) const;
  void count(std::uint32_t difference, bool is_shorter, std::int64_t now);
  bool is_time_to_move(std::int64_t now) const;

  bool started_ = false;
  std::uint32_t reference_ = 0;  ///< µs, difference of the clocks by the usual shortest way
  std::int64_t allowance_ = 0;   ///< ns of drift not yet given to the reference
  std::int64_t observed_at_ = 0;

  std::uint32_t agreeing_ = 0;  ///< messages in a row that would move the reference alike
  bool are_shorter_ = false;    ///< they came by a shorter way; else they are later
  std::uint32_t proposed_ = 0;  ///< µs, the reference by them
  std::int64_t agreeing_since_ = 0;
};

}  // namespace flexcomp
