#pragma once

#include <array>
#include <cstdint>

namespace flexcomp {

/// Names of the numbers that a node reports when asked; stable.
enum class StatisticName : std::uint8_t {
  ticks = 0,
  late_ticks = 1,
  clock_jumps = 2,
  faults = 3,
  saturated_samples = 4,
  implausible_samples = 5,
  foreign_frames = 6,
  dropped_frames = 7,
  stack_used = 8,       ///< bytes, the most there was; 0 where it is not known
  forged_messages = 9,  ///< this and the next two only where a key is configured
  not_fresh_messages = 10,
  unauthenticated_messages = 11,
  late_answers = 12,  ///< this and the next two only with RSI; as the controller counts them
  rsi_sessions = 13,
  limited_answers = 14,
  setpoint_received = 16,
  setpoint_lost = 17,
  setpoint_repeated = 18,
  setpoint_old = 19,
  setpoint_out_of_sequence = 20,
  setpoint_contradicting = 21,
  setpoint_corrupt = 22,
  setpoint_incomplete = 23,
  wrench_received = 32,
  wrench_lost = 33,
  wrench_repeated = 34,
  wrench_old = 35,
  wrench_out_of_sequence = 36,
  wrench_contradicting = 37,
  wrench_corrupt = 38,
  wrench_incomplete = 39,
  latency = 64,  ///< + bin of the histogram
};

/// How often a duration fell into each power of two: bin k counts [2^k, 2^(k+1)) µs, bin 0 also
/// what is shorter, the last one all that is longer.
class LatencyHistogram {
 public:
  static constexpr std::size_t kBins = 16;

  void add(std::int64_t nanoseconds) {
    std::size_t bin = 0;
    for (std::int64_t limit = 2000; nanoseconds >= limit && bin + 1 < kBins; limit *= 2) {
      ++bin;
    }
    ++counts_[bin];
  }

  const std::array<std::uint32_t, kBins>& counts() const { return counts_; }

 private:
  std::array<std::uint32_t, kBins> counts_{};
};

}  // namespace flexcomp
