#pragma once

#include <cstdint>
#include <ctime>

namespace flexcomp {

/// The monotonic clock, ns.
inline std::int64_t monotonic_now() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return std::int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

}  // namespace flexcomp
