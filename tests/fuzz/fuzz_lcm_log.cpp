// Any bytes as an event log of LCM: refused in one line, or read, decoded, and made a recording.
#include "bus_log.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  flexcomp::fuzz::expect_recording_or_one_line(data, size, flexcomp::recording::read_lcm_log);
  return 0;
}
