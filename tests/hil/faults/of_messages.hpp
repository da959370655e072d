#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "hil/faults/injections.hpp"

/// Faults that either stream of messages may have.
namespace flexcomp::test {

inline const StreamCounters& counters(const LinkState& state, Stream stream) {
  return stream == Stream::setpoint ? state.setpoint : state.wrench;
}

inline Counter count_of(std::uint32_t StreamCounters::*counter, Stream stream) {
  return [=](const NodeOnABus& bus) { return counters(bus.link.state(), stream).*counter; };
}

inline Counter count_of_another_sender(Stream stream) {
  return [=](const NodeOnABus& bus) {
    const LinkState state = bus.link.state();
    const StreamCounters& all = counters(state, stream);
    return std::uint64_t{all.contradicting} + all.old + all.out_of_sequence;
  };
}

inline std::vector<Fault> faults_of_messages(Stream stream) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const bool is_setpoint = stream == Stream::setpoint;
  const char* input = is_setpoint ? "setpoint" : "wrench";
  const StatusBit stale = is_setpoint ? kSetpointStale : kWrenchStale;
  const StatusBit not_finite = is_setpoint ? kSetpointNotFinite : kWrenchNotFinite;
  const NodeBit conflict = is_setpoint ? kSetpointConflict : kWrenchConflict;
  const auto fault = [&](int number, const char* what, Reaction reaction, Injection inject) {
    return Fault{number, input, what, reaction, std::move(inject)};
  };
  const auto count = [&](std::uint32_t StreamCounters::*counter) {
    return count_of(counter, stream);
  };
  return {
      fault(2, "lost: one message in four", Reaction::goes_on, losing_every_fourth(stream))
          .told_by(kSomeLost)
          .counted_by(count(&StreamCounters::lost)),
      fault(2, "intermittent: a third of all messages, at random", Reaction::held,
            losing_a_third_at_random(stream))
          .told_by(kSomeLost)
          .counted_by(count(&StreamCounters::lost)),
      fault(3, "repeated: every frame twice", Reaction::goes_on, sending_twice(stream))
          .counted_by(count(&StreamCounters::repeated)),
      fault(4, "out of order: every fourth message after the next", Reaction::goes_on,
            sending_every_fourth_after_the_next(stream))
          .counted_by(count(&StreamCounters::old)),
      fault(5, "off", Reaction::zero, sending_none(stream)).told_by(stale),
      fault(5, "slow: one message in eight ticks", Reaction::held,
            sending_one_in_eight_ticks(stream))
          .told_by(stale),
      fault(5, "delayed: all by 100 ms", Reaction::zero, sending_100_ms_later(stream))
          .told_by(stale),
      fault(5, "delayed, CAN FD: by 1 ms more every tick", Reaction::zero,
            sending_1_ms_later_every_tick(stream))
          .told_by(stale)
          .over_fd(),
      fault(7, "not available: one sample", Reaction::held, not_available(stream, 1))
          .told_by(not_finite),
      fault(7, "not available: all", Reaction::zero, not_available(stream, kAll))
          .told_by(not_finite),
      fault(7, "NaN, CAN FD", Reaction::zero, with_a(kNan, stream)).told_by(not_finite).over_fd(),
      fault(7, "+Inf, CAN FD", Reaction::zero, with_a(HUGE_VAL, stream))
          .told_by(not_finite)
          .over_fd(),
      fault(7, "-Inf, CAN FD", Reaction::zero, with_a(-HUGE_VAL, stream))
          .told_by(not_finite)
          .over_fd(),
      fault(8, "garbage: random bits in every frame", Reaction::zero, random_bits(stream))
          .told_by(stale)
          .told_by(kSomeLost)
          .counted_by(count(&StreamCounters::corrupt)),
      fault(21, "partial sets: the last frame is always missing", Reaction::zero,
            without_the_last_frame(stream))
          .told_by(stale)
          .told_by(kSomeLost)
          .counted_by(count(&StreamCounters::incomplete)),
      fault(22, "two senders", Reaction::zero, two_senders(stream))
          .told_by(conflict)
          .counted_by(count_of_another_sender(stream)),
  };
}

}  // namespace flexcomp::test
