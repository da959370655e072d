#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace flexcomp::cli {

/// A line on standard error that says what long work does now, and for how many seconds it has been
/// doing it; silent where standard error is not a terminal. Of work whose end nobody knows.
class StageLine {
 public:
  StageLine() = default;
  StageLine(const StageLine&) = delete;
  StageLine& operator=(const StageLine&) = delete;
  /// Clears the line.
  ~StageLine();

  void begin(const std::string& stage);

 private:
  void end();
  void tick(const std::string& stage);

  std::thread ticking_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool is_ended_ = false;
};

}  // namespace flexcomp::cli
