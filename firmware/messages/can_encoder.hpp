#pragma once

#include <array>

#include "messages/can_frame.hpp"
#include "messages/can_layout.hpp"
#include "messages/messages.hpp"

namespace flexcomp {

/// The frames of one message.
struct FrameList {
  std::array<CanFrame, kMaxFrameParts> frames{};
  std::size_t count = 0;
};

/// Turns messages into frames, with counters and checksums. Fixed memory, constant time.
class CanEncoder {
 public:
  /// `fd`: use the FD layout where there is one, else classic frames only.
  explicit CanEncoder(bool fd = false) : fd_(fd) {}

  /// No frames for std::monostate and for a data message with more words than the layout has. What
  /// is returned is overwritten by the next call.
  const FrameList& encode(const Message& message);
  const FrameList& encode(const CorrectedMessage& message);

 private:
  std::uint8_t next_counter(FrameGroup group) {
    return counters_[static_cast<std::size_t>(group)]++;
  }

  void put(std::monostate nothing);
  void put(const SetpointMessage& message);
  void put(const WrenchMessage& message);
  void put(const CorrectedMessage& message);
  void put(const TransferDataMessage& message);
  void put(const CommandMessage& message);
  void put(const IdentityMessage& message);
  void put(const TransferBeginMessage& message);
  void put(const TransferEndMessage& message);
  void put(const MeasuredJointsMessage& message);
  void put(const MeasuredPositionMessage& message);
  void put(const HeartbeatMessage& message);
  void put(const FaultMessage& message);
  void put(const StatisticMessage& message);
  void put(const TransferReplyMessage& message);
  void put(const CommandReplyMessage& message);

  bool fd_;
  FrameList list_;
  std::array<std::uint8_t, kFrameGroups> counters_{};
};

}  // namespace flexcomp
