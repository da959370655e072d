#pragma once

#include "recording/bus_recording.hpp"

namespace flexcomp::recording {

/// How one log's clock stands to another's: time₁ = time₂ + offset + rate × (time₂ − origin).
struct ClockAlignment {
  double offset = 0;        ///< s, at the origin
  double rate = 0;          ///< s/s, how much faster the first clock runs
  std::int64_t origin = 0;  ///< ns, of the second clock
  double uncertainty = 0;   ///< s, standard deviation of the offset
};

/// Aligns two logs by what both have seen: the setpoints (or, where one has none, the uncorrected
/// setpoints in the answers). The offset is searched over the whole length of both and then fitted,
/// with the rate, by least squares on the joint angles.
///
/// Throws InputError if they have no setpoints in common or the robot does not move in them.
ClockAlignment align_clocks(const std::vector<LoggedMessage>& first,
                            const std::vector<LoggedMessage>& second);

/// The second log's messages in the first one's time, merged with them in order.
std::vector<LoggedMessage> merge(const std::vector<LoggedMessage>& first,
                                 std::vector<LoggedMessage> second,
                                 const ClockAlignment& alignment);

}  // namespace flexcomp::recording
