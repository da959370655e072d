#pragma once

#include <cstdint>

namespace flexcomp {

/// Freshness values number the messages of a sender by the time: units of 10 µs since 1970-01-01
/// UTC, each more than the one before. So they repeat neither after a restart nor in 5 million
/// years, and nobody has to keep them.
using Freshness = std::uint64_t;

/// The time now, in those units; as a parameter so that tests have a clock of their own.
using FreshnessClock = Freshness (*)();

/// How far a value may be from the receiver's clock: 0.25 s. The clocks have to agree so far; a
/// message that is held back is taken this much later at most.
constexpr Freshness kFreshnessWindow = 25'000;

/// How long a clock must stay where it was set to be followed, ns.
constexpr std::int64_t kClockSettles = 10'000'000'000;

/// The time of day without its jumps: goes on by the monotonic clock when somebody sets the clock,
/// and follows only where the clock stays where it was set for ten seconds. A clock that is wrong
/// for a moment then neither makes every message old, nor lets a value far ahead be taken after
/// which none of the true time is.
class SteadyTime {
 public:
  /// `clock`: the time of day; `monotonic`: ns.
  Freshness at(Freshness clock, std::int64_t monotonic);

 private:
  bool started_ = false;
  std::int64_t offset_ = 0;  ///< of the time of day from the monotonic clock, in units of Freshness
  std::int64_t jump_ = 0;    ///< what the clock shows beyond that, 0 where it has not jumped
  std::int64_t jumped_at_ = 0;
};

/// The value closest to `clock` whose low `bits` (below 64) are `low`.
Freshness whole_freshness(Freshness low, unsigned bits, Freshness clock);

/// Gives the messages of a sender their freshness values.
class FreshnessSource {
 public:
  Freshness next(Freshness clock) {
    last_ = clock > last_ ? clock : last_ + 1;
    return last_;
  }

 private:
  Freshness last_ = 0;
};

/// Lets through what a receiver takes: values above the last one taken, and within the window about
/// its clock. The first value taken is beyond the window at the start, so that nothing that was
/// sent before a restart can be taken after it; the stream is refused as long.
class FreshnessGate {
 public:
  explicit FreshnessGate(Freshness clock_at_start = 0) : last_(clock_at_start + kFreshnessWindow) {}

  bool is_fresh(Freshness value, Freshness clock) const {
    return value > last_ && value + kFreshnessWindow >= clock && value <= clock + kFreshnessWindow;
  }

  /// Nothing up to `value` is fresh any more.
  void close_up_to(Freshness value) { last_ = value > last_ ? value : last_; }

 private:
  Freshness last_;
};

}  // namespace flexcomp
