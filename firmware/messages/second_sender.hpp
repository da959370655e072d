#pragma once

#include <array>
#include <cstdint>

namespace flexcomp {

/// Evidence that a second sender is at work in a stream, kept for as long as it takes a slow one to
/// give enough of it.
///
/// Each event is something that one sender does not do: another content under a counter that it has
/// just used, a counter far off its own between two that follow each other, or a second format
/// beside the first. Eight events at once prove a second sender. One event is forgotten every two
/// seconds, because a faulty bus may bring about one now and then: a second sender with events at a
/// rate of r a second is found after 16 / (2 - 1/r) of them, so within 32 where r is 2/3 or more.
class SecondSender {
 public:
  /// An event at `now` (ns, only grows).
  void raise(std::int64_t now);

  /// True from the proof on, until `clear`.
  bool is_proven() const { return is_proven_; }

  void clear() { *this = SecondSender(); }

 private:
  std::int64_t level_ = 0;  ///< ns until all events are forgotten
  std::int64_t raised_at_ = 0;
  bool is_proven_ = false;
};

/// Content of the last messages of a stream, by their counters: a message that comes late says the
/// same again, one of a second sender does not.
class RecentContents {
 public:
  /// The next that came, `step` after the one before; what did not come in between is not known.
  void add(std::uint32_t counter, std::uint32_t step, std::uint32_t digest) {
    if (step != 1) {
      forget_between(counter, step);
    }
    const std::uint32_t slot = counter % kCount;
    known_ |= 1U << slot;
    digest_[slot] = shortened(digest);
  }

  /// Did the message with this counter, one of the last, hold something else?
  bool contradict(std::uint32_t counter, std::uint32_t digest) const {
    const std::uint32_t slot = counter % kCount;
    return (known_ >> slot & 1U) != 0 && digest_[slot] != shortened(digest);
  }

 private:
  static constexpr std::uint32_t kCount = 8;  // more than the losses in a row that are borne

  static std::uint16_t shortened(std::uint32_t digest) {
    return static_cast<std::uint16_t>(digest ^ digest >> 16);
  }

  void forget_between(std::uint32_t counter, std::uint32_t step);

  std::array<std::uint16_t, kCount> digest_{};
  std::uint32_t known_ = 0;  ///< one bit a slot
};

/// How a message came to the node.
enum class Source : std::uint8_t { can_classic, can_fd, lcm, rsi, sensor };

/// Lets one format and transport at a time have a stream (setpoints or wrenches).
///
/// A message of another source is refused, and counts as a second sender's, while the source that
/// has the stream is at work: until its last message is 50 ms old. Then the other may take over, as
/// a sender that was started anew in another format does.
class SourceMonitor {
 public:
  /// Is a message of this source to be used? `now` (ns) only grows.
  bool admit(Source source, std::int64_t now);

  bool has_conflict() const { return second_.is_proven(); }
  void clear_conflict() { second_.clear(); }
  std::uint32_t refused() const { return refused_; }  ///< messages of another source

 private:
  bool has_source_ = false;
  Source source_ = Source::can_classic;
  std::int64_t admitted_at_ = 0;
  std::uint32_t refused_ = 0;
  SecondSender second_;
};

}  // namespace flexcomp
