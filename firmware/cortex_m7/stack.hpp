#pragma once

#include <cstddef>
#include <cstdint>

namespace flexcomp::cortex_m7 {

/// Fills what is unused of the stack with a pattern, and makes the memory below it inaccessible, so
/// that an overflow is a fault and not a corruption. To be called once, early in main().
void prepare_stack();

/// Bytes of stack, the most that were ever used.
std::uint32_t stack_used();

}  // namespace flexcomp::cortex_m7
