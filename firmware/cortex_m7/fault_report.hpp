#pragma once

#include <cstdint>

namespace flexcomp::cortex_m7 {

/// State of the processor when it could not go on (Armv7-M Architecture Reference Manual, B1.5.6
/// and B3.2.15 to B3.2.18).
struct FaultReport {
  std::uint32_t program_counter;  ///< 0 if the stack had no room to keep it
  std::uint32_t link_register;
  std::uint32_t configurable_status;  ///< CFSR
  std::uint32_t hard_status;          ///< HFSR
  std::uint32_t address;              ///< BFAR, if bit 15 of CFSR says so
};

/// The handler of every fault: takes down the report and calls `fault_reported`.
[[gnu::naked]] void fault();

}  // namespace flexcomp::cortex_m7

/// Handles a fault, and must not return. Each program has its own.
extern "C" [[noreturn]] void fault_reported(const flexcomp::cortex_m7::FaultReport& report);
