#include "cli/stage_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

namespace flexcomp::cli {

StageLine::~StageLine() { end(); }

void StageLine::begin(const std::string& stage) {
  if (::isatty(STDERR_FILENO) == 0) {
    return;
  }
  end();
  is_ended_ = false;
  ticking_ = std::thread([this, stage] { tick(stage); });
}

void StageLine::end() {
  if (!ticking_.joinable()) {
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_ended_ = true;
  }
  ended_.notify_one();
  ticking_.join();
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
}

void StageLine::tick(const std::string& stage) {
  std::unique_lock<std::mutex> lock(mutex_);
  for (int second = 0; !is_ended_; ++second) {
    fmt::print(stderr, "\r\033[K{}, {} s", stage, second);
    std::fflush(stderr);
    ended_.wait_for(lock, std::chrono::seconds(1), [this] { return is_ended_; });
  }
}

}  // namespace flexcomp::cli
