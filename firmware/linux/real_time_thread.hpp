#pragma once

#include <pthread.h>
#include <semaphore.h>

#include <functional>

namespace flexcomp {

/// A thread for real-time work: memory locked, stack touched in advance, SCHED_FIFO where allowed.
class RealTimeThread {
 public:
  /// Starts it, named "flexcomp-rt", and waits until it has its priority. `priority` 0 asks for
  /// ordinary scheduling. What the system does not allow is said on standard error, and done
  /// without.
  RealTimeThread(int priority, std::function<void()> work);
  ~RealTimeThread();
  RealTimeThread(const RealTimeThread&) = delete;
  RealTimeThread& operator=(const RealTimeThread&) = delete;

 private:
  static void* enter(void* self);

  int priority_;
  std::function<void()> work_;
  sem_t ready_{};
  pthread_t thread_{};
};

}  // namespace flexcomp
