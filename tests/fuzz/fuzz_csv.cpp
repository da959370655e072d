// Any bytes as a recording in CSV: refused in one line, or read as what it can be written as.
#include "byte_source.hpp"
#include "complaint.hpp"
#include "host/scratch_folder.hpp"
#include "memory_file.hpp"
#include "recording/recording.hpp"

using namespace flexcomp;
using flexcomp::fuzz::expect;
using flexcomp::fuzz::MemoryFile;

namespace {

/// Written and read again it has the same numbers.
void check_second_reading(const recording::Recording& first, const std::filesystem::path& file) {
  recording::write_recording(file, first);
  const recording::Recording second = recording::read_recording(file);
  expect(first.time == second.time, "times survive being written");
  expect(first.q_cmd.has_value() == second.q_cmd.has_value(), "groups survive being written");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const test::ScratchFolder folder;
  const MemoryFile file(data, size);
  fuzz::expect_one_line_or_none(file.path().string(), [&] {
    check_second_reading(recording::read_recording(file.path()), folder / "again.csv");
  });
  return 0;
}
