#pragma once

#include <cstdint>

#include "messages/second_sender.hpp"
#include "messages/sequence.hpp"

namespace flexcomp {

/// Who sent a datagram: address and port as one number.
using RsiPeer = std::uint64_t;

/// Judges which telegrams of a controller are to be used, by their sender and their IPOC.
///
/// IPOC counts the controller's time: it grows by the same step each cycle. A KUKA counts in
/// milliseconds (4 or 12); simulators count in ones too. The step is learned from the telegrams.
///
/// A session is one run of RSI on the controller. Another begins where the old one cannot have gone
/// on: half a second without a telegram; after a pause of 50 ms an IPOC that does not go on from
/// the last one, or another sender; at any time a count of late answers that has shrunk. The
/// correction that a controller moves by is then zero again.
class RsiSession {
 public:
  enum class Verdict : std::uint8_t {
    begun,     ///< to be used, as the first of a session
    next,      ///< to be used
    repeated,  ///< the last one again: to be answered as it was
    refused,   ///< not to be used, nor answered
  };

  /// `tolerated`: telegrams in a row that may be lost without a break.
  explicit RsiSession(std::uint32_t tolerated) : tolerated_(tolerated) {}

  /// Judges a telegram and counts it. `late`: answers that were late, as the controller counts, or
  /// 0 where it does not say; `digest`: any number made from the content; `now` (ns) only grows.
  Verdict judge(RsiPeer peer, std::uint64_t ipoc, std::uint64_t late, std::uint32_t digest,
                std::int64_t now);

  /// Cycles between the last telegram that was used and the one before it, whose telegrams never
  /// came.
  std::uint64_t missed() const { return missed_; }

  /// Answers that the controller found late between those two.
  std::uint64_t newly_late() const { return newly_late_; }

  std::uint32_t sessions() const { return sessions_; }

  /// Do two controllers send (`SecondSender`)?
  bool has_conflict() const { return second_.is_proven(); }
  void clear_conflict() { second_.clear(); }

  StreamCounters counters;

 private:
  struct Telegram {
    RsiPeer peer = 0;
    std::uint64_t ipoc = 0;
    std::uint64_t late = 0;
    std::uint32_t digest = 0;
    std::int64_t at = 0;  ///< ns
  };

  Verdict judge_other(const Telegram& telegram);
  Verdict judge_same_ipoc(const Telegram& telegram);
  bool goes_on(std::uint64_t ipoc, bool paused);
  Verdict begin(const Telegram& telegram);

  std::uint32_t tolerated_;
  bool has_last_ = false;
  Telegram last_;
  std::uint64_t step_ = 0;  ///< of IPOC a cycle; 0: not yet known
  std::uint64_t missed_ = 0;
  std::uint64_t newly_late_ = 0;
  std::uint32_t sessions_ = 0;
  SecondSender second_;
};

}  // namespace flexcomp
