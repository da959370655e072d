// Any bytes as a log of candump: refused in one line, or read, decoded, and made a recording.
#include "byte_source.hpp"
#include "complaint.hpp"
#include "memory_file.hpp"
#include "recording/bus_recording.hpp"

using namespace flexcomp;
using flexcomp::fuzz::MemoryFile;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file(data, size);
  const std::string name = file.path().string();
  fuzz::expect_one_line_or_none(name, [&] {
    const auto frames = recording::read_candump_log(file.path());
    recording::DecodingCounts counts;
    const auto messages = recording::decode(frames, &counts);
    fuzz::expect(messages.size() + counts.foreign <= frames.size(), "no message from nothing");
    recording::to_recording(messages, false, name);
  });
  return 0;
}
