#include "linux/can_sender.hpp"

#include <algorithm>

namespace flexcomp {
namespace {

constexpr std::uint32_t kLongestWait = 64;  // ticks
constexpr std::uint32_t kFramesAfterFullQueue = 50;
constexpr std::uint32_t kFramesAfterBusFault = 500;

}  // namespace

void CanSender::send(const CanFrame* frames, std::size_t count) {
  const std::size_t taken = waiting_ > 0 ? 0 : socket_->send(frames, count);
  taken_ += static_cast<std::uint32_t>(taken);
  if (taken < count) {
    dropped_ += static_cast<std::uint32_t>(count - taken);
    if (waiting_ == 0) {
      back_off(kFramesAfterFullQueue);
    }
    return;
  }
  if (fault_ && taken_ >= frames_to_recover_) {
    fault_ = false;
    wait_ = 0;
    frames_to_recover_ = 0;
  }
}

void CanSender::observe(CanSocket::Received event) {
  if (event == CanSocket::Received::bus_off) {
    back_off(kFramesAfterBusFault);
  } else if (event == CanSocket::Received::bus_passive) {
    fault_ = true;
    taken_ = 0;
    frames_to_recover_ = kFramesAfterBusFault;
  } else if (event == CanSocket::Received::bus_restarted) {
    waiting_ = 0;
  }
}

void CanSender::tick() { waiting_ -= waiting_ > 0 ? 1U : 0U; }

void CanSender::back_off(std::uint32_t frames_to_recover) {
  fault_ = true;
  frames_to_recover_ = std::max(frames_to_recover_, frames_to_recover);
  taken_ = 0;
  wait_ = std::clamp(2 * wait_, 1U, kLongestWait);
  waiting_ = wait_;
}

}  // namespace flexcomp
