#include "linux/real_time_thread.hpp"

#include <sys/mman.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace flexcomp {
namespace {

constexpr std::size_t kStackBytes = 512 << 10;
constexpr std::size_t kTouchedBytes = 128 << 10;

void touch_stack() {
  std::array<volatile unsigned char, kTouchedBytes> memory;
  for (std::size_t i = 0; i < memory.size(); i += 1024) {
    memory[i] = 0;
  }
}

void set_priority(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  if (error != 0) {
    std::fprintf(stderr, "flexcompd: no SCHED_FIFO (%s): runs at ordinary priority\n",
                 std::strerror(error));
  }
}

}  // namespace

RealTimeThread::RealTimeThread(int priority, std::function<void()> work) : work_(std::move(work)) {
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    std::fprintf(stderr, "flexcompd: memory cannot be locked (%s)\n", std::strerror(errno));
  }
  if (priority > 0) {
    work_ = [priority, inner = std::move(work_)] {
      set_priority(priority);
      inner();
    };
  }
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStackBytes);
  const int error = pthread_create(&thread_, &attributes, enter, this);
  pthread_attr_destroy(&attributes);
  if (error != 0) {
    throw std::runtime_error(std::string("cannot start a thread: ") + std::strerror(error));
  }
}

RealTimeThread::~RealTimeThread() { pthread_join(thread_, nullptr); }

void* RealTimeThread::enter(void* self) {
  touch_stack();
  pthread_setname_np(pthread_self(), "flexcomp-rt");
  static_cast<RealTimeThread*>(self)->work_();
  // From here on it may touch the heap: the thread is taken apart.
  pthread_setname_np(pthread_self(), "flexcomp-end");
  return nullptr;
}

}  // namespace flexcomp
