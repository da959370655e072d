/// A stack that overflows is a fault, and reported as one; ends with success when it was.
#include <cstdio>

#include "cortex_m7/fault_report.hpp"
#include "cortex_m7/stack.hpp"

extern "C" {

extern std::uint32_t __stack_guard[];
[[noreturn]] void main_returned(int result);

void fault_reported(const flexcomp::cortex_m7::FaultReport& report) {
  constexpr std::uint32_t kMemoryFault = 0xFF;  // CFSR
  const bool was_memory = (report.configurable_status & kMemoryFault) != 0;
  std::printf("fault at %08lx, CFSR %08lx\n", static_cast<unsigned long>(report.program_counter),
              static_cast<unsigned long>(report.configurable_status));
  main_returned(was_memory ? 0 : 1);
}

}  // extern "C"

namespace {

volatile int endless = 1'000'000'000;

[[gnu::noinline]] int deeper(int level) {
  volatile int here[32] = {level};
  return (level < endless ? deeper(level + 1) : 0) + here[level % 32];
}

}  // namespace

int main() {
  flexcomp::cortex_m7::prepare_stack();
  const std::uint32_t before = flexcomp::cortex_m7::stack_used();
  std::printf("%lu bytes used\n", static_cast<unsigned long>(before));
  if (before == 0 || before > 64 * 1024) {
    return 2;
  }
  return 3 + deeper(0);
}
