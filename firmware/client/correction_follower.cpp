#include "client/correction_follower.hpp"

#include <algorithm>

namespace flexcomp {
namespace {

constexpr double kAtZero = 1e-6;  // rad, a few steps of what travels on the bus

}  // namespace

CorrectionFollower::CorrectionFollower(double period, double hold_time, double fade_time)
    : period_(period), hold_time_(hold_time), fade_time_(fade_time) {}

void CorrectionFollower::take(const Correction& correction, bool off) {
  if (!correction.allFinite()) {
    return;
  }
  const bool at_zero = correction_.cwiseAbs().maxCoeff() <= kAtZero;
  if (off && at_zero) {
    lost_ = false;
  }
  if (lost_ || (off && !at_zero)) {
    return;
  }
  correction_ = correction;
  answered_ = true;
}

void CorrectionFollower::end_period() {
  missing_ = answered_ ? 0 : missing_ + period_;
  answered_ = false;
  if (!lost_ && missing_ > hold_time_) {
    lost_ = true;
    held_ = correction_;
  }
  if (lost_) {
    const double faded = (missing_ - hold_time_) / fade_time_;
    correction_ = std::max(0.0, 1 - faded) * held_;
  }
}

}  // namespace flexcomp
