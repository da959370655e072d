#include "messages/second_sender.hpp"

namespace flexcomp {
namespace {

constexpr std::int64_t kForgetAfter = 2'000'000'000;  // ns an event
constexpr std::int64_t kProof = 8 * kForgetAfter;
constexpr std::int64_t kPause = 50'000'000;  // ns, after which another source may take over

}  // namespace

void SecondSender::raise(std::int64_t now) {
  const std::int64_t elapsed = now - raised_at_;
  level_ = level_ > elapsed ? level_ - elapsed : 0;
  level_ += kForgetAfter;
  raised_at_ = now;
  is_proven_ = is_proven_ || level_ > kProof - kForgetAfter;
}

void RecentContents::forget_between(std::uint32_t counter, std::uint32_t step) {
  if (step >= kCount) {
    known_ = 0;
  }
  for (std::uint32_t back = 1; back < step && back < kCount; ++back) {
    known_ &= ~(1U << ((counter - back) % kCount));
  }
}

bool SourceMonitor::admit(Source source, std::int64_t now) {
  if (has_source_ && source != source_ && now - admitted_at_ <= kPause) {
    ++refused_;
    second_.raise(now);
    return false;
  }
  has_source_ = true;
  source_ = source;
  admitted_at_ = now;
  return true;
}

}  // namespace flexcomp
