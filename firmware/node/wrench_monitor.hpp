#pragma once

#include <array>
#include <cstdint>

#include "messages/messages.hpp"

namespace flexcomp {

struct WrenchMonitorConfig {
  double force_rate = 1e6;   ///< N/s, largest plausible change
  double moment_rate = 1e5;  ///< N·m/s
  double stuck_time = 0;     ///< s, the same bits for so long while the robot moves; 0: not checked
};

/// Looks at a stream of wrenches for what the value alone does not show: a sensor that is stuck,
/// jumps, or stands at the end of its range.
class WrenchMonitor {
 public:
  void configure(const WrenchMonitorConfig& config) {
    config_ = config;
    has_last_ = false;
  }

  /// Is this sample to be used? Not if it is saturated (a clamped value is no measurement) or
  /// changed faster than it can since the last one that was used, received at `now` (ns).
  bool accept(const WrenchMessage& message, std::int64_t now);

  /// To be told every tick whether the robot moves.
  void observe_motion(bool moving, std::int64_t now);

  bool is_stuck() const { return stuck_; }
  bool last_was_saturated() const { return saturated_; }
  bool last_was_implausible() const { return implausible_; }
  std::uint32_t saturated_samples() const { return saturated_samples_; }
  std::uint32_t implausible_samples() const { return implausible_samples_; }

 private:
  const std::array<double, 6>& finite_part(const std::array<double, 6>& wrench);
  double largest_change(const std::array<double, 6>& wrench, std::size_t first) const;
  bool is_plausible(double force_change, double moment_change, std::int64_t now) const;

  WrenchMonitorConfig config_;
  std::array<double, 6> last_{};
  std::array<double, 6> finite_{};  ///< room for `finite_part`
  bool has_last_ = false;
  std::int64_t used_at_ = 0;
  std::int64_t changed_at_ = 0;
  std::int64_t still_time_ = 0;  ///< ns, since the last change, in which the robot did not move
  std::int64_t observed_at_ = 0;
  bool stuck_ = false;
  bool saturated_ = false;
  bool implausible_ = false;
  std::uint32_t saturated_samples_ = 0;
  std::uint32_t implausible_samples_ = 0;
};

}  // namespace flexcomp
