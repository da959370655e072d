#include "cortex_m7/fault_report.hpp"

namespace {

std::uint32_t system_control(std::uint32_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}

}  // namespace

/// `frame` is what the processor pushed: r0 to r3, r12, lr, pc, status.
extern "C" [[noreturn, gnu::used]] void report_fault(const std::uint32_t* frame) {
  const flexcomp::cortex_m7::FaultReport report = {frame[6], frame[5], system_control(0xE000ED28),
                                                   system_control(0xE000ED2C),
                                                   system_control(0xE000ED38)};
  fault_reported(report);
}

void flexcomp::cortex_m7::fault() {
  asm volatile(
      "tst lr, #4\n"
      "ite eq\n"
      "mrseq r0, msp\n"
      "mrsne r0, psp\n"
      "b report_fault\n");
}
