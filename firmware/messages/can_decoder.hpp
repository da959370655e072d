#pragma once

#include <array>

#include "messages/can_frame.hpp"
#include "messages/can_layout.hpp"
#include "messages/messages.hpp"
#include "messages/sequence.hpp"

namespace flexcomp {

/// A message that has come whole: which, and the payloads of its frames one after the other; null
/// for none. To be unpacked before the decoder gets the next frame.
struct WholeMessage {
  FrameGroup group{};
  const std::uint8_t* payloads = nullptr;
};

/// Turns frames into messages: checks length and checksum, puts sets together, judges counters, and
/// unpacks through the codec that is generated from flexcomp.dbc. Fixed memory, constant time.
class CanDecoder {
 public:
  /// `tolerated`: messages in a row of one stream that may be lost without a break.
  explicit CanDecoder(std::uint32_t tolerated = 3);

  /// The message that this frame completes, or std::monostate for none. `now` (ns) only grows.
  Message decode(const CanFrame& frame, std::int64_t now);

  /// The same in two steps, for who wants one kind of message only, by `can::unpack`.
  WholeMessage take(const CanFrame& frame, std::int64_t now);
  static Message message(const WholeMessage& whole);

  SequenceMonitor& monitor(FrameGroup group) {
    return streams_[static_cast<std::size_t>(group)].monitor;
  }
  const SequenceMonitor& monitor(FrameGroup group) const {
    return streams_[static_cast<std::size_t>(group)].monitor;
  }

  /// Frames with an identifier that is not in flexcomp.dbc.
  std::uint32_t foreign_frames() const { return foreign_frames_; }

 private:
  /// Payloads of the frames of a classic set, one after the other.
  using Payloads = std::array<std::uint8_t, 8 * kMaxFrameParts>;

  /// Parts of one classic set, on their way in, and those of the last one that was accepted.
  struct Set {
    std::uint8_t received = 0;  ///< one bit a part
    std::uint8_t next = 0;      ///< which payloads are on their way in; the others were accepted
    std::uint32_t counter = 0;
    alignas(std::uint32_t) std::array<Payloads, 2> payloads{};
  };
  static_assert(kMaxFrameParts <= 8, "a bit a part");

  struct Stream {
    SequenceMonitor monitor;
    Set set;
  };

  static void drop_repeated_part(const FrameLayout& layout, const CanFrame& frame, std::int64_t now,
                                 Stream* whole);
  static bool begins_anew(const FrameLayout& layout, std::uint32_t counter, Stream* whole);
  static const std::uint8_t* add_part(const FrameLayout& layout, const CanFrame& frame,
                                      std::int64_t now, Stream* whole);

  std::array<Stream, kFrameGroups> streams_;
  std::uint32_t foreign_frames_ = 0;
};

}  // namespace flexcomp
