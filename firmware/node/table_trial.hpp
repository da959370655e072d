#pragma once

#include "flexcomp/compensator.hpp"
#include "messages/messages.hpp"
#include "node/node_status.hpp"

namespace flexcomp {

/// Has a node run with the table in use? It has once the correction was active, without a fault,
/// for so many ticks in a row. Until then a new table is on trial.
class TableTrial {
 public:
  static constexpr std::uint32_t kTicks = 250;  // a second at 4 ms

  /// A table has been put to use.
  void begin() { good_ticks_ = 0; }

  /// To be told what every tick came to.
  void observe(const CorrectedMessage& tick) {
    const bool good = tick.state == static_cast<std::uint8_t>(State::active) &&
                      (tick.status & kFaultBits) == 0 && (tick.node_status & kNodeFaultBits) == 0;
    if (good_ticks_ < kTicks) {
      good_ticks_ = good ? good_ticks_ + 1 : 0;
    }
  }

  bool has_run() const { return good_ticks_ == kTicks; }

 private:
  std::uint32_t good_ticks_ = 0;
};

}  // namespace flexcomp
