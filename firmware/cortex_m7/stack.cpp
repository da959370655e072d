#include "cortex_m7/stack.hpp"

#include "cortex_m7/register_at.hpp"

extern "C" {
extern std::uint32_t __stack_guard[];
extern std::uint32_t __stack_bottom[];
extern std::uint32_t __stack_top[];
}

namespace flexcomp::cortex_m7 {
namespace {

constexpr std::uint32_t kPaint = 0xA5C3F00F;

/// Armv7-M Architecture Reference Manual, B3.5: region 0 of the memory protection unit, 256 bytes,
/// no access; elsewhere the default map. The handlers of hard faults and of the watchdog run
/// without it, and have the guarded bytes for their own.
void guard_stack() {
  constexpr std::uint32_t kNoExecution = 1U << 28U;
  constexpr std::uint32_t kSize256 = 7U << 1U;
  constexpr std::uint32_t kEnableRegion = 1;
  constexpr std::uint32_t kEnableWithDefaultMap = 5;
  register_at(0xE000ED98) = 0;
  register_at(0xE000ED9C) = reinterpret_cast<std::uint32_t>(__stack_guard);
  register_at(0xE000EDA0) = kNoExecution | kSize256 | kEnableRegion;
  register_at(0xE000ED94) = kEnableWithDefaultMap;
  asm volatile("dsb\n isb" ::: "memory");
}

}  // namespace

void prepare_stack() {
  constexpr std::ptrdiff_t kOwn = 32;  // words, for this call
  auto* const in_use = static_cast<std::uint32_t*>(__builtin_frame_address(0));
  for (std::uint32_t* word = __stack_bottom; word < in_use - kOwn; ++word) {
    *word = kPaint;
  }
  guard_stack();
}

std::uint32_t stack_used() {
  const std::uint32_t* lowest = __stack_bottom;
  while (lowest < __stack_top && *lowest == kPaint) {
    ++lowest;
  }
  return static_cast<std::uint32_t>(__stack_top - lowest) * sizeof(std::uint32_t);
}

}  // namespace flexcomp::cortex_m7
