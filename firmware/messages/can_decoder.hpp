#pragma once

#include <array>

#include "messages/can_frame.hpp"
#include "messages/can_layout.hpp"
#include "messages/messages.hpp"
#include "messages/sequence.hpp"

namespace flexcomp {

/// Turns frames into messages: checks length and checksum, puts sets together, judges counters, and
/// unpacks through the codec that is generated from flexcomp.dbc. Fixed memory, constant time.
class CanDecoder {
 public:
  /// `tolerated`: messages in a row of one stream that may be lost without a break.
  explicit CanDecoder(std::uint32_t tolerated = 3);

  /// The message that this frame completes, or std::monostate for none. `now` (ns) only grows.
  Message decode(const CanFrame& frame, std::int64_t now);

  SequenceMonitor& monitor(FrameGroup group) { return monitors_[static_cast<std::size_t>(group)]; }
  const SequenceMonitor& monitor(FrameGroup group) const {
    return monitors_[static_cast<std::size_t>(group)];
  }

  /// Frames with an identifier that is not in flexcomp.dbc.
  std::uint32_t foreign_frames() const { return foreign_frames_; }

 private:
  /// Payloads of the frames of a classic set, one after the other.
  using Payloads = std::array<std::uint8_t, 8 * kMaxFrameParts>;

  /// Parts of one classic set, on their way in.
  struct Set {
    std::uint32_t received = 0;  ///< one bit a part
    std::uint32_t counter = 0;
    Payloads parts{};
    Payloads accepted{};
  };

  bool complete(const FrameLayout& layout, const CanFrame& frame, std::int64_t now);
  bool add_part(const FrameLayout& layout, const CanFrame& frame, std::int64_t now);

  std::array<SequenceMonitor, kFrameGroups> monitors_;
  std::array<Set, kFrameGroups> sets_{};
  std::uint32_t foreign_frames_ = 0;
};

}  // namespace flexcomp
