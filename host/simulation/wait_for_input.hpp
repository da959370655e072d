#pragma once

#include <poll.h>

#include <cstdint>

namespace flexcomp::simulation {

/// Waits until a file descriptor can be read from; false after `patience` ns.
inline bool wait_for_input(int descriptor, std::int64_t patience) {
  pollfd input{descriptor, POLLIN, 0};
  timespec time{};
  time.tv_sec = patience / 1'000'000'000;
  time.tv_nsec = patience % 1'000'000'000;
  return ppoll(&input, 1, &time, nullptr) > 0;
}

}  // namespace flexcomp::simulation
