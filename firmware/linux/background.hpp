#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

namespace flexcomp {

/// Says on standard error what can be said without waiting for who reads it.
void say_at_once(const char* text);

/// A thread for work that may take long, or never end: files on a disk that stalls, a terminal that
/// nobody reads. Jobs are done one after the other. Who hands them over never waits.
class Background {
 public:
  Background();

  /// A job that has not ended by then keeps the thread and what the job itself holds, no more: a
  /// job must hold all that it uses.
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Hands over a job; false, and it is not done, if too many wait. What it throws is said on
  /// standard error.
  bool start(std::function<void()> job);

  /// Says a message as `complain` does, after what was started before.
  bool say(const std::string& message);

  /// Waits until all jobs are done; false if they are not within `patience`.
  bool finish(std::chrono::milliseconds patience);

 private:
  struct Jobs;

  std::shared_ptr<Jobs> jobs_;
};

}  // namespace flexcomp
