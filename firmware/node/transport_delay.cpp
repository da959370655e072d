#include "node/transport_delay.hpp"

#include "messages/messages.hpp"

namespace flexcomp {
namespace {

constexpr std::int64_t kMicrosecond = 1000;
constexpr std::int64_t kDriftDivisor = 10'000;  // 100 ppm

}  // namespace

std::int64_t TransportDelay::observe(std::int64_t timestamp, std::int64_t now) {
  if (timestamp == kNoTime) {
    return 0;
  }
  const auto difference = static_cast<std::uint32_t>(now / kMicrosecond) -
                          static_cast<std::uint32_t>(timestamp / kMicrosecond);
  if (!started_) {
    started_ = true;
    reference_ = difference;
  } else {
    allowance_ += (now - observed_at_) / kDriftDivisor;
    reference_ += static_cast<std::uint32_t>(allowance_ / kMicrosecond);
    allowance_ %= kMicrosecond;
  }
  observed_at_ = now;
  const auto delay = static_cast<std::int32_t>(difference - reference_);
  if (delay < 0) {
    reference_ = difference;
    return 0;
  }
  return kMicrosecond * delay;
}

}  // namespace flexcomp
