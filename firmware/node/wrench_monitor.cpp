#include "node/wrench_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "node/seconds.hpp"

namespace flexcomp {
namespace {

bool are_finite(const std::array<double, 6>& numbers) {
  double sum = 0;  // of zeros, or not a number
#pragma GCC unroll 6
  for (const double number : numbers) {
    sum += 0 * number;
  }
  return sum == 0;
}

}  // namespace

bool WrenchMonitor::accept(const WrenchMessage& message, std::int64_t now) {
  saturated_ = message.saturated;
  if (saturated_) {
    ++saturated_samples_;
    return false;
  }
  // A number that is not finite goes on to the compensator, which names it, but measures no change.
  const bool finite = are_finite(message.wrench);
  const std::array<double, 6>& wrench = finite ? message.wrench : finite_part(message.wrench);
  const double force_change = largest_change(wrench, 0);
  const double moment_change = largest_change(wrench, 3);
  implausible_ = has_last_ && !is_plausible(force_change, moment_change, now);
  if (implausible_) {
    ++implausible_samples_;
    return false;
  }
  if (!has_last_ || !finite || force_change > 0 || moment_change > 0) {
    changed_at_ = now;
    still_time_ = 0;
    stuck_ = false;
  }
  last_ = wrench;
  has_last_ = true;
  used_at_ = now;
  return true;
}

/// With what was last in the place of what is not finite.
[[gnu::noinline]] const std::array<double, 6>& WrenchMonitor::finite_part(
    const std::array<double, 6>& wrench) {
  for (std::size_t i = 0; i < wrench.size(); ++i) {
    finite_[i] = std::isfinite(wrench[i]) ? wrench[i] : last_[i];
  }
  return finite_;
}

/// The largest of the force (`first` 0) or of the moment (3).
double WrenchMonitor::largest_change(const std::array<double, 6>& wrench, std::size_t first) const {
  const auto change = [&](std::size_t i) { return std::fabs(wrench[i] - last_[i]); };
  return std::max(std::max(change(first), change(first + 1)), change(first + 2));
}

bool WrenchMonitor::is_plausible(double force_change, double moment_change,
                                 std::int64_t now) const {
  // Samples in one tick carry no time between them; nothing changes within a tenth of a
  // millisecond.
  const double elapsed = std::fmax(static_cast<double>(seconds(now - used_at_)), 1e-4);
  return !(force_change > config_.force_rate * elapsed) &&
         !(moment_change > config_.moment_rate * elapsed);
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
