#include "messages/sequence.hpp"

namespace flexcomp {
namespace {

constexpr std::int64_t kResynchroniseAfter = 50'000'000;  // ns without an accepted message
constexpr std::uint32_t kMessagesAfterPause = 3;
constexpr std::uint32_t kMessagesAfterGap = 2;
// A dropped message weighs more than an accepted one, so that two senders in step are found after
// about 32 messages, and a burst of a few late ones is not taken for a second sender.
constexpr std::uint32_t kSuspicionOfDropped = 2;
constexpr std::uint32_t kConflictAt = 32;

}  // namespace

[[gnu::always_inline]] inline void SequenceMonitor::take(std::uint32_t counter,
                                                         std::uint32_t digest, std::int64_t now) {
  ++counters.received;
  recent_.add(counter, ahead(counter, last_), digest);
  last_ = counter;
  accepted_at_ = now;
  consistent_ = 0;
  suspicion_ -= suspicion_ > 0 ? 1U : 0U;
}

bool SequenceMonitor::accept(std::uint32_t counter, std::uint32_t digest, std::int64_t now) {
  counter &= modulus_ - 1;
  const bool starts_anew = may_restart_ && now - accepted_at_ > kResynchroniseAfter;
  if (!started_ || starts_anew) {
    started_ = true;
    take(counter, digest, now);
    return true;
  }
  const std::uint32_t step = ahead(counter, last_);
  if (step == 0) {
    drop_repetition(!recent_.contradict(counter, digest), now);
    return false;
  }
  const bool follows = step <= tolerated_ + 1;
  if (follows || is_resynchronised(counter, now)) {
    // One sender that has lost messages goes on from where it is; it does not come back.
    if (follows && has_stray_ && now - accepted_at_ <= kResynchroniseAfter) {
      second_.raise(now);
    }
    has_stray_ = false;
    counters.lost += step - 1;
    take(counter, digest, now);
    return true;
  }
  const bool is_far_off = step > tolerated_ + 1 && modulus_ - step > tolerated_;
  if (!is_far_off && recent_.contradict(counter, digest)) {
    contradict(now);
    return false;
  }
  ++(step > modulus_ / 2 ? counters.old : counters.out_of_sequence);
  has_stray_ = has_stray_ || is_far_off;
  suspect();
  return false;
}

void SequenceMonitor::drop_repetition(bool same_content, std::int64_t now) {
  if (same_content) {
    ++counters.repeated;
  } else {
    contradict(now);
  }
}

void SequenceMonitor::contradict(std::int64_t now) {
  ++counters.contradicting;
  // After a pause the counter may have come round.
  if (now - accepted_at_ <= kResynchroniseAfter) {
    second_.raise(now);
  }
  suspect();
}

void SequenceMonitor::drop_late() {
  ++counters.old;
  suspect();
}

void SequenceMonitor::clear_conflict() {
  conflict_ = false;
  suspicion_ = 0;
  second_.clear();
}

void SequenceMonitor::suspect() {
  suspicion_ += kSuspicionOfDropped;
  if (suspicion_ >= kConflictAt) {
    suspicion_ = kConflictAt;
    conflict_ = true;
  }
}

bool SequenceMonitor::is_resynchronised(std::uint32_t counter, std::int64_t now) {
  const std::uint32_t step = ahead(counter, candidate_);
  consistent_ = step >= 1 && step <= tolerated_ + 1 ? consistent_ + 1 : 1;
  candidate_ = counter;
  // A message behind may be late, and is then never used, unless the sender has started anew.
  const bool paused = now - accepted_at_ > kResynchroniseAfter;
  return is_behind(counter) ? consistent_ >= kMessagesAfterPause && paused
                            : consistent_ >= kMessagesAfterGap;
}

}  // namespace flexcomp
