/// From reset to main(): vector table, memory, floating-point unit, constructors.
#include <cstdint>

#include "cortex_m7/fault_report.hpp"

extern "C" {

extern std::uint32_t __data_start[];
extern std::uint32_t __data_end[];
extern const std::uint32_t __data_load[];
extern std::uint32_t __bss_start[];
extern std::uint32_t __bss_end[];
extern std::uint32_t __stack_top[];
extern void (*const __init_array_start[])();
extern void (*const __init_array_end[])();

int program() asm("main");  // C++ lets nobody call main by its name
[[noreturn]] void reset();
/// Ends a program whose main() has returned `result`.
[[noreturn]] void main_returned(int result);
/// Called a thousand times a second by programs that start SysTick; others need none.
void tick();

[[gnu::weak]] void tick() {}

}  // extern "C"

namespace {

using Handler = void (*)();

/// Armv7-M Architecture Reference Manual, B1.5.2 and B1.5.3.
struct Vectors {
  std::uint32_t* stack;
  Handler handlers[15];
};

[[gnu::section(".vectors"), gnu::used]] const Vectors vectors = {
    __stack_top,
    {reset, flexcomp::cortex_m7::fault,  // non-maskable interrupt
     flexcomp::cortex_m7::fault,         // hard fault
     flexcomp::cortex_m7::fault,         // memory management fault
     flexcomp::cortex_m7::fault,         // bus fault
     flexcomp::cortex_m7::fault,         // usage fault
     nullptr, nullptr, nullptr, nullptr,
     flexcomp::cortex_m7::fault,  // supervisor call
     flexcomp::cortex_m7::fault,  // debug monitor
     nullptr,
     flexcomp::cortex_m7::fault,  // PendSV
     tick}};

/// Coprocessor access control register (B3.2.20): full access to the floating-point unit.
void enable_floating_point() {
  auto* const access = reinterpret_cast<volatile std::uint32_t*>(0xE000ED88);
  *access = *access | 0xFU << 20U;
  asm volatile("dsb\n isb" ::: "memory");
}

}  // namespace

void reset() {
  enable_floating_point();
  const std::uint32_t* from = __data_load;
  for (std::uint32_t* to = __data_start; to < __data_end; ++to, ++from) {
    *to = *from;
  }
  for (std::uint32_t* to = __bss_start; to < __bss_end; ++to) {
    *to = 0;
  }
  for (auto constructor = __init_array_start; constructor < __init_array_end; ++constructor) {
    (*constructor)();
  }
  main_returned(program());
}
