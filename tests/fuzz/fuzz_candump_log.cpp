// Any bytes as a log of candump: refused in one line, or read, decoded, and made a recording.
#include "bus_log.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  flexcomp::fuzz::expect_recording_or_one_line(data, size, flexcomp::recording::read_candump_log);
  return 0;
}
