#pragma once

#include "messages/sequence.hpp"
#include "node/node.hpp"

namespace flexcomp {

/// A node's receiving side of LCM, beside CanLink: judges the sequence numbers of setpoints and
/// wrenches, and hands over what is in order.
class LcmReceiver {
 public:
  /// `tolerated`: messages in a row of one stream that may be lost without a break.
  explicit LcmReceiver(std::uint32_t tolerated);

  /// Hands a message to the node. True if it is a setpoint that is used.
  bool receive(const Message& message, std::uint32_t sequence, Node* node, std::int64_t now);

  /// Adds counters and conflicts of the streams to those of the other link.
  void add_to(LinkState* state) const;
  void forget_conflicts();

 private:
  SequenceMonitor setpoint_;
  SequenceMonitor wrench_;
};

}  // namespace flexcomp
