#pragma once

#include "byte_source.hpp"
#include "complaint.hpp"
#include "memory_file.hpp"
#include "recording/bus_recording.hpp"

namespace flexcomp::fuzz {

/// Reads the bytes as a bus's log by `read`, decodes what it holds, and makes recordings of it:
/// refused in one line, or done.
template <typename Read>
void expect_recording_or_one_line(const std::uint8_t* data, std::size_t size, const Read& read) {
  const MemoryFile file(data, size);
  const std::string name = file.path().string();
  expect_one_line_or_none(name, [&] {
    const auto logged = read(file.path());
    recording::DecodingCounts counts;
    const auto messages = recording::decode(logged, &counts);
    expect(messages.size() + counts.foreign <= logged.size(), "no message from nothing");
    recording::to_recording(messages, false, name);
    recording::to_recording(messages, true, name);
  });
}

}  // namespace flexcomp::fuzz
