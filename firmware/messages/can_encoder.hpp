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
  void put(std::monostate nothing);
  template <typename Content>
  void put(const Content& message);
  template <typename Format, typename Content>
  void put_in(const Content& message);

  bool fd_;
  FrameList list_;
  std::array<std::uint8_t, kFrameGroups> counters_{};
};

}  // namespace flexcomp
