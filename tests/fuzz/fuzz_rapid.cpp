// Any text as a RAPID module: refused in one line with the file's name, or read as motions that can
// be.
#include "program_check.hpp"
#include "programs/rapid_reader.hpp"

using namespace flexcomp;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  fuzz::expect_one_line_or_none("p.mod", [&] {
    fuzz::check_program(
        bytes, [](const std::string& text) { return programs::rapid_program("p.mod", text); });
  });
  return 0;
}
