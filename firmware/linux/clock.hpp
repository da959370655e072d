#pragma once

#include <cstdint>
#include <ctime>

#include "messages/freshness.hpp"

namespace flexcomp {

/// The monotonic clock, ns.
inline std::int64_t monotonic_now() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return std::int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

/// The time of day as messages with a key carry it: without jumps, for each thread by itself.
inline Freshness freshness_now() {
  thread_local SteadyTime steady;
  timespec time{};
  clock_gettime(CLOCK_REALTIME, &time);
  const Freshness clock = Freshness{100'000} * static_cast<Freshness>(time.tv_sec) +
                          static_cast<Freshness>(time.tv_nsec / 10'000);
  return steady.at(clock, monotonic_now());
}

}  // namespace flexcomp
