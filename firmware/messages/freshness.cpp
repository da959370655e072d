#include "messages/freshness.hpp"

namespace flexcomp {
namespace {

constexpr std::int64_t kUnit = 10'000;  // ns
/// 10 ms: more than NTP's slewing between two messages, and far less than the window.
constexpr std::int64_t kSlewed = 1'000;

bool is_slewed(std::int64_t difference) { return difference >= -kSlewed && difference <= kSlewed; }

}  // namespace

Freshness SteadyTime::at(Freshness clock, std::int64_t monotonic) {
  const std::int64_t elapsed = monotonic / kUnit;
  if (!started_) {
    started_ = true;
    offset_ = static_cast<std::int64_t>(clock) - elapsed;
  }
  const std::int64_t beyond = static_cast<std::int64_t>(clock) - elapsed - offset_;
  const bool has_jumped = !is_slewed(beyond);
  if (has_jumped && (jump_ == 0 || !is_slewed(beyond - jump_))) {
    jump_ = beyond;
    jumped_at_ = monotonic;
  }
  if (!has_jumped || monotonic - jumped_at_ >= kClockSettles) {
    offset_ += beyond;
    jump_ = 0;
  }
  return static_cast<Freshness>(elapsed + offset_);
}

Freshness whole_freshness(Freshness low, unsigned bits, Freshness clock) {
  const Freshness range = Freshness{1} << bits;
  const Freshness half = range / 2;
  // How far ahead of the clock, up to half the range; else it is behind.
  const Freshness ahead = (low - clock) & (range - 1);
  return ahead < half ? clock + ahead : clock + ahead - range;
}

}  // namespace flexcomp
