#include "node/transport_delay.hpp"

#include "messages/messages.hpp"
#include "messages/microseconds.hpp"

namespace flexcomp {
namespace {

constexpr std::int64_t kMicrosecond = 1000;
constexpr std::int64_t kDriftDivisor = 10'000;  // 100 ppm
/// µs: a busy computer's messages scatter by so much, and a delay that matters is no smaller.
constexpr std::int32_t kAgreement = 10'000;
constexpr std::uint32_t kShorterInARow = 4;
constexpr std::uint32_t kLaterInARow = 16;
constexpr std::int64_t kLaterFor = 1'000'000'000;  // ns

}  // namespace

std::int64_t TransportDelay::observe(std::int64_t timestamp, std::int64_t now) {
  if (timestamp == kNoTime) {
    return 0;
  }
  const std::uint32_t difference = low_microseconds(now) - low_microseconds(timestamp);
  if (!started_) {
    started_ = true;
    reference_ = difference;
    observed_at_ = now;
    return 0;
  }
  follow_drift(now);
  const auto delay = static_cast<std::int32_t>(difference - reference_);
  if (delay >= 0 && delay <= kAgreement) {
    agreeing_ = 0;
    return kMicrosecond * delay;
  }
  count(difference, delay < 0, now);
  if (is_time_to_move(now)) {
    reference_ = proposed_;
    agreeing_ = 0;
    return 0;
  }
  return delay < 0 ? 0 : kMicrosecond * delay;
}

void TransportDelay::follow_drift(std::int64_t now) {
  const std::int64_t elapsed = now - observed_at_;
  constexpr std::int64_t kShort = 1'000'000'000;  // ns; what is divided then has 32 bits
  if (elapsed >= 0 && elapsed <= kShort && allowance_ >= 0) {
    const std::uint32_t allowance =
        static_cast<std::uint32_t>(allowance_) +
        static_cast<std::uint32_t>(elapsed) / std::uint32_t{kDriftDivisor};
    reference_ += allowance / std::uint32_t{kMicrosecond};
    allowance_ = allowance % std::uint32_t{kMicrosecond};
  } else {
    allowance_ += elapsed / kDriftDivisor;
    reference_ += static_cast<std::uint32_t>(allowance_ / kMicrosecond);
    allowance_ %= kMicrosecond;
  }
  observed_at_ = now;
}

bool TransportDelay::agrees(std::uint32_t difference) const {
  const auto off = static_cast<std::int32_t>(difference - proposed_);
  return off >= -kAgreement && off <= kAgreement;
}

/// Proposes, of ways that were shorter, the longest, because none of them was longer; of messages
/// that were later, the earliest.
void TransportDelay::count(std::uint32_t difference, bool is_shorter, std::int64_t now) {
  if (agreeing_ == 0 || is_shorter != are_shorter_ || !agrees(difference)) {
    agreeing_ = 1;
    are_shorter_ = is_shorter;
    proposed_ = difference;
    agreeing_since_ = now;
    return;
  }
  ++agreeing_;
  const bool is_longer = static_cast<std::int32_t>(difference - proposed_) > 0;
  proposed_ = is_longer == is_shorter ? difference : proposed_;
}

bool TransportDelay::is_time_to_move(std::int64_t now) const {
  return are_shorter_ ? agreeing_ >= kShorterInARow
                      : agreeing_ >= kLaterInARow && now - agreeing_since_ >= kLaterFor;
}

}  // namespace flexcomp
