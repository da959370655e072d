#include "cortex_m7/fault_report.hpp"

#include "cortex_m7/register_at.hpp"

extern "C" {

extern const std::uint32_t __stack_bottom[];

/// `frame` is what the processor pushed: r0 to r3, r12, lr, pc, status. Where the stack had no room
/// for it, it pushed nothing.
[[noreturn, gnu::used]] void report_fault(const std::uint32_t* frame) {
  constexpr std::uint32_t kPushFailed = 0x1010;  // CFSR: MSTKERR, STKERR
  const std::uint32_t status = flexcomp::cortex_m7::register_at(0xE000ED28);
  const bool pushed = frame >= __stack_bottom && (status & kPushFailed) == 0;
  const flexcomp::cortex_m7::FaultReport report = {
      pushed ? frame[6] : 0, pushed ? frame[5] : 0, status,
      flexcomp::cortex_m7::register_at(0xE000ED2C), flexcomp::cortex_m7::register_at(0xE000ED38)};
  fault_reported(report);
}

}  // extern "C"

void flexcomp::cortex_m7::fault() {
  asm volatile(
      "tst lr, #4\n"
      "ite eq\n"
      "mrseq r0, msp\n"
      "mrsne r0, psp\n"
      "ldr r1, =__stack_bottom\n"
      "cmp r0, r1\n"
      "ldr r1, =__stack_top\n"
      "it lo\n"
      "movlo sp, r1\n"  // what is on an overflown stack will not be returned to
      "b report_fault\n");
}
