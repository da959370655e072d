#include "rsi/session.hpp"

namespace flexcomp {
namespace {

constexpr std::int64_t kPause = 50'000'000;        // ns, after which others may take over
constexpr std::int64_t kEnd = 500'000'000;         // ns, after which the controller has given up
constexpr std::uint64_t kLargestFirstStep = 1000;  // of IPOC, from the first telegram to the second

RsiSession::Verdict refuse(std::uint32_t* counter) {
  ++*counter;
  return RsiSession::Verdict::refused;
}

}  // namespace

RsiSession::Verdict RsiSession::judge(RsiPeer peer, std::uint64_t ipoc, std::uint64_t late,
                                      std::uint32_t digest, std::int64_t now) {
  const Telegram telegram{peer, ipoc, late, digest, now};
  const std::int64_t silence = now - last_.at;
  if (!has_last_ || silence > kEnd) {
    return begin(telegram);
  }
  if (peer != last_.peer) {
    return judge_other(telegram);
  }
  if (ipoc == last_.ipoc) {
    return judge_same_ipoc(telegram);
  }
  const bool paused = silence > kPause;
  if (!goes_on(ipoc, paused)) {
    return paused ? begin(telegram)
                  : refuse(ipoc < last_.ipoc ? &counters.old : &counters.out_of_sequence);
  }
  if (late < last_.late) {
    return begin(telegram);
  }
  missed_ = (ipoc - last_.ipoc) / step_ - 1;
  newly_late_ = late - last_.late;
  counters.lost += static_cast<std::uint32_t>(missed_);
  ++counters.received;
  last_ = telegram;
  return Verdict::next;
}

/// A telegram of another sender than the session's.
RsiSession::Verdict RsiSession::judge_other(const Telegram& telegram) {
  if (telegram.at - last_.at > kPause) {
    return begin(telegram);
  }
  second_.raise(telegram.at);
  return refuse(&counters.contradicting);
}

RsiSession::Verdict RsiSession::judge_same_ipoc(const Telegram& telegram) {
  if (telegram.digest != last_.digest) {
    second_.raise(telegram.at);
    return refuse(&counters.contradicting);
  }
  ++counters.repeated;
  return Verdict::repeated;
}

/// Does an IPOC follow the last one? After a pause any number of cycles may be missing.
bool RsiSession::goes_on(std::uint64_t ipoc, bool paused) {
  if (ipoc < last_.ipoc) {
    return false;
  }
  const std::uint64_t ahead = ipoc - last_.ipoc;
  if (step_ == 0) {
    step_ = ahead <= kLargestFirstStep ? ahead : 0;
    return step_ != 0;
  }
  if (ahead < step_ && step_ % ahead == 0) {
    step_ = ahead;  // telegrams were lost where the step was learned
  }
  return ahead % step_ == 0 && (paused || ahead / step_ - 1 <= tolerated_);
}

RsiSession::Verdict RsiSession::begin(const Telegram& telegram) {
  has_last_ = true;
  last_ = telegram;
  step_ = 0;
  missed_ = 0;
  newly_late_ = 0;
  ++sessions_;
  ++counters.received;
  return Verdict::begun;
}

}  // namespace flexcomp
