// Any text as a KRL program: refused in one line with the file's name, or read as motions that can
// be.
#include "program_check.hpp"
#include "programs/krl_reader.hpp"

using namespace flexcomp;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  fuzz::expect_one_line_or_none("p.src", [&] {
    fuzz::check_program(bytes, [](const std::string& text) {
      return programs::krl_program("p.src", text,
                                   "DEFDAT p\nDECL E6POS XP1={X 1,Y 2,Z 3,A 4,B 5,C 6}\nENDDAT\n");
    });
  });
  return 0;
}
