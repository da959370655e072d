#pragma once

#include <vector>

#include "hil/faults/injections.hpp"

/// Faults of the bus, of those on it, of the clock and of the memory.
namespace flexcomp::test {

inline std::uint64_t late_ticks(const NodeOnABus& bus) { return bus.node.late_ticks(); }

inline std::uint64_t clock_jumps(const NodeOnABus& bus) {
  bool exists = false;
  return bus.node.statistic(static_cast<std::uint8_t>(StatisticName::clock_jumps), &exists);
}

inline Injection bus_off() {
  return machining([](NodeOnABus* bus, int) { bus->bus_fault = true; });
}

inline Injection another_node() {
  return [other = CanEncoder()](NodeOnABus* bus, int) mutable {
    bus->put(other.encode(CorrectedMessage{kNoTime, {}, {}, 0, 0, 0}));
    return bus->machine();
  };
}

inline Injection announcing(std::uint64_t model_hash, WrenchFrame frame) {
  return machining([=](NodeOnABus* bus, int) { bus->send(IdentityMessage{model_hash, frame}); });
}

inline Injection turning_a_bit_of_the_table() {
  return machining([](NodeOnABus* bus, int tick) {
    if (tick == 0) {
      bus->first_slot()[usual_table().size() - 1] ^= 1;
    }
  });
}

inline std::vector<Fault> faults_of_surroundings() {
  const std::uint64_t own_hash = usual_config().compensator.model_hash;
  return {
      Fault{1, "bus", "off for 0.8 s", Reaction::zero, bus_off()}.told_by(kBusFault),
      Fault{22, "bus", "another node sends corrected setpoints", Reaction::zero, another_node()}
          .told_by(kOtherNode),
      Fault{11, "identity", "the sender changes its tool while correcting", Reaction::zero,
            announcing(1234, WrenchFrame::base)}
          .told_by(kIdentityMismatch),
      Fault{11, "identity", "the wrench comes in the tool frame", Reaction::zero,
            announcing(own_hash, WrenchFrame::tool)}
          .told_by(kIdentityMismatch),
      Fault{12, "table", "one bit of the table in use turns over", Reaction::zero,
            turning_a_bit_of_the_table()}
          .told_by(kTableDamaged)
          .where([](NodeConfig* config) { config->compensator.fade_time = 0.02F; }),
      Fault{19, "tick", "one in ten comes two periods late", Reaction::goes_on,
            ticking_after([](int tick) { return tick % 10 == 0 ? 12'000'000 : 4'000'000; })}
          .counted_by(late_ticks),
      Fault{19, "tick", "all come a period late", Reaction::zero,
            ticking_after([](int) { return 8'000'000; })}
          .told_by(kTickLate)
          .counted_by(late_ticks),
      Fault{19, "tick", "the clock stands, then jumps back", Reaction::zero,
            ticking_after([](int tick) { return tick % 2 == 0 ? 0 : -1'000'000; })}
          .told_by(kTickLate)
          .counted_by(clock_jumps),
  };
}

}  // namespace flexcomp::test
