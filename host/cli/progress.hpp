#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace flexcomp::cli {

/// A line on standard error that says how far a long piece of work is and how long it will take;
/// silent where standard error is not a terminal.
class Progress {
 public:
  Progress(std::string label, std::size_t total);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  void show(std::size_t done);

 private:
  using Clock = std::chrono::steady_clock;

  std::string label_;
  std::size_t total_;
  bool is_terminal_;
  bool is_shown_ = false;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point last_ = begun_;
};

}  // namespace flexcomp::cli
