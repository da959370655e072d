#include "cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace flexcomp::cli {

Progress::Progress(std::string label, std::size_t total)
    : label_(std::move(label)), total_(total), is_terminal_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (is_shown_) {
    fmt::print(stderr, "\r\033[K");
  }
}

void Progress::show(std::size_t done) {
  const Clock::time_point now = Clock::now();
  if (!is_terminal_ || done == 0 || now - last_ < std::chrono::milliseconds(200)) {
    return;
  }
  last_ = now;
  is_shown_ = true;
  const double share = static_cast<double>(done) / static_cast<double>(total_);
  const double elapsed = std::chrono::duration<double>(now - begun_).count();
  fmt::print(stderr, "\r\033[K{} {:3.0f} %, {:.0f} s left", label_, 100 * share,
             elapsed * (1 - share) / share);
  std::fflush(stderr);
}

}  // namespace flexcomp::cli
