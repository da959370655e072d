/// Lets a test program on the target print, and end with its result, through the debugger or
/// emulator (Arm semihosting, by newlib's librdimon).
#include <unistd.h>

#include <cstddef>
#include <cstdio>

#include "cortex_m7/fault_report.hpp"

extern "C" {

extern char __test_heap_start[];
extern char __test_heap_end[];

void initialise_monitor_handles();

/// Calls that the standard library of a test needs; a program that never ends needs no more.
void* __dso_handle = nullptr;

[[noreturn]] void main_returned(int result);

[[gnu::constructor(101)]] void open_console() { initialise_monitor_handles(); }

/// More heap for malloc, as newlib asks for it.
void* _sbrk(std::ptrdiff_t more) {
  static char* used = __test_heap_start;
  if (more > __test_heap_end - used) {
    std::printf("a test needs more than %ld bytes of heap\n",
                static_cast<long>(__test_heap_end - __test_heap_start));
    main_returned(4);
  }
  char* const given = used;
  used += more;
  return given;
}

void main_returned(int result) {
  std::fflush(stdout);
  _exit(result);
}

/// Programs that expect a fault have their own.
[[gnu::weak]] void fault_reported(const flexcomp::cortex_m7::FaultReport& report) {
  std::printf("fault at %08lx, called from %08lx: CFSR %08lx, HFSR %08lx, BFAR %08lx\n",
              static_cast<unsigned long>(report.program_counter),
              static_cast<unsigned long>(report.link_register),
              static_cast<unsigned long>(report.configurable_status),
              static_cast<unsigned long>(report.hard_status),
              static_cast<unsigned long>(report.address));
  main_returned(3);
}

}  // extern "C"
