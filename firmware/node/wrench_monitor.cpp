#include "node/wrench_monitor.hpp"

#include <cmath>

#include "node/seconds.hpp"

namespace flexcomp {

bool WrenchMonitor::accept(const WrenchMessage& message, std::int64_t now) {
  saturated_ = message.saturated;
  if (saturated_) {
    ++saturated_samples_;
    return false;
  }
  implausible_ = has_last_ && !is_plausible(message.wrench, now);
  if (implausible_) {
    ++implausible_samples_;
    return false;
  }
  if (!has_last_ || message.wrench != last_) {
    changed_at_ = now;
    still_time_ = 0;
    stuck_ = false;
  }
  for (std::size_t i = 0; i < last_.size(); ++i) {
    // A number that is not finite goes on to the compensator, which names it, but measures no
    // change.
    last_[i] = std::isfinite(message.wrench[i]) ? message.wrench[i] : last_[i];
  }
  has_last_ = true;
  used_at_ = now;
  return true;
}

bool WrenchMonitor::is_plausible(const std::array<double, 6>& wrench, std::int64_t now) const {
  // Samples in one tick carry no time between them; nothing changes within a tenth of a
  // millisecond.
  const double elapsed = std::fmax(static_cast<double>(seconds(now - used_at_)), 1e-4);
  for (std::size_t i = 0; i < wrench.size(); ++i) {
    const double rate = i < 3 ? config_.force_rate : config_.moment_rate;
    if (std::isfinite(wrench[i]) && std::fabs(wrench[i] - last_[i]) > rate * elapsed) {
      return false;
    }
  }
  return true;
}

void WrenchMonitor::observe_motion(bool moving, std::int64_t now) {
  if (!moving) {
    still_time_ += now - observed_at_;
  }
  observed_at_ = now;
  if (config_.stuck_time > 0 && has_last_ && moving) {
    const float same_for = seconds(now - changed_at_ - still_time_);
    stuck_ = static_cast<double>(same_for) > config_.stuck_time;
  }
}

}  // namespace flexcomp
