#pragma once

#include "messages/can_decoder.hpp"
#include "messages/can_encoder.hpp"
#include "node/node.hpp"

namespace flexcomp {

/// A node's side of a CAN bus: frames in and out, whatever moves them (SocketCAN, SLCAN, a test).
class CanLink {
 public:
  /// `fd`: send corrected setpoints as FD frames. `tolerated`: see CanDecoder.
  CanLink(bool fd, std::uint32_t tolerated) : decoder_(tolerated), encoder_(fd) {}

  /// Hands a frame to the node. True if it completed a setpoint that is used.
  bool receive(const CanFrame& frame, Node* node, std::int64_t now);

  /// As CanEncoder: overwritten by the next call.
  template <typename SomeMessage>
  const FrameList& encode(const SomeMessage& message) {
    return encoder_.encode(message);
  }

  /// Counters and conflicts of the streams. Node::take_reset asks to forget conflicts.
  LinkState state() const;
  /// The same, into what is there: what else it says stays.
  void report(LinkState* state) const;
  void forget_conflicts();

 private:
  static bool deliver(const WholeMessage& whole, bool fd, Node* node, std::int64_t now);

  CanDecoder decoder_;
  CanEncoder encoder_;
};

/// Both layouts of a stream together.
StreamCounters operator+(const StreamCounters& a, const StreamCounters& b);

}  // namespace flexcomp
