#pragma once

#include <pthread.h>

#include <functional>

namespace flexcomp {

/// A thread for real-time work: memory locked, stack touched in advance, SCHED_FIFO where allowed.
class RealTimeThread {
 public:
  /// Starts it, named "flexcomp-rt". `priority` 0 asks for ordinary scheduling. What the system
  /// does not allow is said on standard error, and done without.
  RealTimeThread(int priority, std::function<void()> work);
  ~RealTimeThread();
  RealTimeThread(const RealTimeThread&) = delete;
  RealTimeThread& operator=(const RealTimeThread&) = delete;

 private:
  static void* enter(void* self);

  std::function<void()> work_;
  pthread_t thread_{};
};

}  // namespace flexcomp
