#pragma once

#include <cstdint>

#include "messages/second_sender.hpp"

namespace flexcomp {

/// Counts of the messages of one stream, by what became of them.
struct StreamCounters {
  std::uint32_t received = 0;         ///< accepted
  std::uint32_t lost = 0;             ///< gaps between accepted ones
  std::uint32_t repeated = 0;         ///< the same again
  std::uint32_t old = 0;              ///< overtaken by a newer one: dropped
  std::uint32_t out_of_sequence = 0;  ///< further ahead than losses explain: dropped
  std::uint32_t contradicting = 0;    ///< same counter, other content: two senders
  std::uint32_t corrupt = 0;          ///< checksum, length or format
  std::uint32_t incomplete = 0;       ///< sets given up because a part was missing
};

/// Judges the counter of a stream of messages, after the receiver of AUTOSAR's E2E profiles:
/// accepts the next one and small gaps; drops repetitions and what comes late; after a large gap
/// accepts again only once the stream has been consistent for a while and nothing else was
/// accepted.
class SequenceMonitor {
 public:
  /// `modulus`: the counter wraps there (a power of two). `tolerated`: messages in a row that may
  /// be lost without a break. `may_restart`: after a pause any counter is accepted, as for
  /// commands, which come from a program that is started for each anew.
  explicit SequenceMonitor(std::uint32_t modulus = 16, std::uint32_t tolerated = 3,
                           bool may_restart = false)
      : modulus_(modulus), tolerated_(tolerated), may_restart_(may_restart) {}

  /// Is a message with this counter and content to be used? Counts what it sees. `digest` is any
  /// number made from the content; `now` (ns) only grows.
  bool accept(std::uint32_t counter, std::uint32_t digest, std::int64_t now);

  /// How a counter stands to that of the last accepted message, for the parts of a set.
  bool is_repetition(std::uint32_t counter) const { return started_ && ahead(counter, last_) == 0; }
  bool is_behind(std::uint32_t counter) const {
    return started_ && ahead(counter, last_) > modulus_ / 2;
  }

  /// Counts what was dropped without being asked about.
  void drop_repetition(bool same_content, std::int64_t now);
  void drop_late();

  /// Do two senders seem to be at work: for some time as many messages dropped as accepted, or
  /// enough of what one sender does not do (`SecondSender`)?
  bool has_conflict() const { return conflict_ || second_.is_proven(); }
  void clear_conflict();

  StreamCounters counters;
  /// Has anything been counted?
  bool has_counted() const { return started_ || counters.corrupt != 0 || counters.incomplete != 0; }

 private:
  std::uint32_t ahead(std::uint32_t counter, std::uint32_t of) const {
    return (counter - of) & (modulus_ - 1);
  }
  void take(std::uint32_t counter, std::uint32_t digest, std::int64_t now);
  void contradict(std::int64_t now);
  void suspect();
  bool is_resynchronised(std::uint32_t counter, std::int64_t now);

  std::uint32_t modulus_;
  std::uint32_t tolerated_;
  bool may_restart_;
  bool started_ = false;
  std::uint32_t last_ = 0;
  RecentContents recent_;
  std::int64_t accepted_at_ = 0;
  std::uint32_t candidate_ = 0;  ///< counter of the last message that was dropped
  std::uint32_t consistent_ = 0;
  std::uint32_t suspicion_ = 0;
  bool conflict_ = false;
  bool has_stray_ = false;  ///< a counter far off was dropped since the last accepted message
  SecondSender second_;
};

}  // namespace flexcomp
