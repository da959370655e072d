#pragma once

#include <functional>
#include <string>
#include <utility>

#include "node/node_on_a_bus.hpp"

/// The fault catalogue's entries. Number, input and text name one; the rest says what is expected
/// of it.
namespace flexcomp::test {

/// Behaviour that is expected of the correction while the fault lasts.
enum class Reaction {
  goes_on,  ///< stays active
  held,     ///< holds, and comes back by itself when the fault ends
  zero,     ///< reaches zero in bounded time and stays there until reset
};

inline const char* name(Reaction reaction) {
  switch (reaction) {
    case Reaction::goes_on:
      return "goes on";
    case Reaction::held:
      return "holds, then goes on";
    case Reaction::zero:
      return "fades to zero, latches";
  }
  return "";
}

/// A fault as it is done to the bus, a tick at a time: sends what there is to send, and ticks. It
/// may remember the ticks before.
using Injection = std::function<CorrectedMessage(NodeOnABus*, int tick)>;

/// A counter of the node or of its link, which a fault makes grow.
using Counter = std::function<std::uint64_t(const NodeOnABus&)>;

struct Fault {
  int number;         ///< in the catalogue
  const char* input;  ///< setpoint, wrench, ...
  const char* what;
  Reaction reaction;
  Injection inject;

  std::uint32_t status = 0;       ///< bits of which one must be seen
  std::uint16_t node_status = 0;  ///< or one of these
  Counter counter = {};           ///< must grow; may be empty
  NodeConfig config = usual_config();
  bool fd = false;  ///< the sender's frames from the start: a change of format is a second sender

  std::string label() const {
    return std::to_string(number) + " " + std::string(input) + ": " + what;
  }

  Fault&& told_by(std::uint32_t bits) && {
    status = bits;
    return std::move(*this);
  }

  Fault&& told_by(NodeBit bit) && {
    node_status = bit;
    return std::move(*this);
  }

  Fault&& counted_by(Counter grows) && {
    counter = std::move(grows);
    return std::move(*this);
  }

  Fault&& over_fd() && {
    fd = true;
    return std::move(*this);
  }

  Fault&& where(const std::function<void(NodeConfig*)>& change) && {
    change(&config);
    return std::move(*this);
  }
};

}  // namespace flexcomp::test
