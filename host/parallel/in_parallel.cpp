#include "parallel/in_parallel.hpp"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace flexcomp {
namespace {

/// Cores that this process may use: fewer than the machine has where mpirun or a service manager
/// has bound it to some.
unsigned usable_cores() {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) {
    return static_cast<unsigned>(CPU_COUNT(&allowed));
  }
  return std::max(1U, std::thread::hardware_concurrency());
}

}  // namespace

void in_parallel(std::size_t count, const std::function<void(std::size_t, std::size_t)>& progress,
                 const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::mutex failing;
  const auto run = [&](bool tells) {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(failing);
        failure = failure ? failure : std::current_exception();
        next = count;
      }
      if (tells) {
        progress(std::min<std::size_t>(next, count), count);
      }
    }
  };
  std::vector<std::thread> helpers;
  for (unsigned i = 1; i < usable_cores(); ++i) {
    helpers.emplace_back(run, false);
  }
  run(true);
  for (std::thread& helper : helpers) {
    helper.join();
  }
  if (failure) {
    std::rethrow_exception(failure);
  }
}

}  // namespace flexcomp
