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

RealTimeThread::RealTimeThread(int priority, std::function<void()> work)
    : priority_(priority), work_(std::move(work)) {
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    std::fprintf(stderr, "flexcompd: memory cannot be locked (%s)\n", std::strerror(errno));
  }
  sem_init(&ready_, 0, 0);
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStackBytes);
  const int error = pthread_create(&thread_, &attributes, enter, this);
  pthread_attr_destroy(&attributes);
  if (error != 0) {
    sem_destroy(&ready_);
    throw std::runtime_error(std::string("cannot start a thread: ") + std::strerror(error));
  }
  while (sem_wait(&ready_) != 0) {  // a signal came between
  }
}

RealTimeThread::~RealTimeThread() {
  pthread_join(thread_, nullptr);
  sem_destroy(&ready_);
}

void* RealTimeThread::enter(void* self) {
  auto* thread = static_cast<RealTimeThread*>(self);
  touch_stack();
  pthread_setname_np(pthread_self(), "flexcomp-rt");
  if (thread->priority_ > 0) {
    set_priority(thread->priority_);
  }
  sem_post(&thread->ready_);
  thread->work_();
  // From here on it may touch the heap: the thread is taken apart.
  pthread_setname_np(pthread_self(), "flexcomp-end");
  return nullptr;
}

}  // namespace flexcomp
