/// The firmware: a node on a serial line. Priorities, highest first: the line's interrupts;
/// SysTick, which runs the node and feeds the watchdog while the program below it is alive; this
/// program, which checks tables and looks after the rest.
#include <atomic>

#include "cortex_m7/board.hpp"
#include "cortex_m7/fault_report.hpp"
#include "cortex_m7/register_at.hpp"
#include "cortex_m7/stack.hpp"

namespace {

using flexcomp::IndexMemory;
using flexcomp::NodeSettings;
using flexcomp::SlcanNode;
using flexcomp::TableSlot;
using flexcomp::cortex_m7::FaultReport;
using flexcomp::cortex_m7::register_at;
namespace board = flexcomp::cortex_m7::board;

constexpr std::uint32_t kStepsASecond = 1000;
constexpr std::uint32_t kWatchdogTime = 500;  // ms
// The main program may be busy with a table for so many steps: 512 KiB with a signature and an
// index are some seventy million instructions, 2.8 s at 25 MHz.
constexpr std::uint32_t kLongestCheck = 4000;

SlcanNode::Bytes received;
SlcanNode::Bytes to_send;
SlcanNode* node = nullptr;
std::atomic<std::uint32_t> steps{0};
std::atomic<std::uint32_t> seen{0};  ///< steps, when the main program last looked

/// The last fault, kept over a reset of the processor.
struct LastWords {
  static constexpr std::uint32_t kValid = 0x4641554C;
  std::uint32_t valid;
  FaultReport report;
};
[[gnu::section(".noinit")]] LastWords last_words;

}  // namespace

extern "C" {

extern const std::uint32_t __settings_start[];
extern const std::uint32_t __settings_end[];
extern const std::uint32_t __table_start[];
extern const std::uint32_t __table_end[];
extern std::uint32_t __first_slot[];
extern std::uint32_t __second_slot[];
extern std::uint32_t __slots_end[];
extern std::uint32_t __first_index[];
extern std::uint32_t __second_index[];
extern std::uint32_t __fixed_index[];
extern std::uint32_t __indices_end[];

void tick() {
  static std::int64_t now = 0;
  now += board::elapsed();
  node->step(now);
  board::wake_sender();
  const std::uint32_t done = steps.load(std::memory_order_relaxed) + 1;
  steps.store(done, std::memory_order_relaxed);
  if (done - seen.load(std::memory_order_relaxed) <= kLongestCheck) {
    board::feed_watchdog();
  }
}

/// Armv7-M Architecture Reference Manual, B3.2.6: a reset by software.
[[noreturn]] void restart() {
  asm volatile("dsb" ::: "memory");
  register_at(0xE000ED0C) = 0x05FA0004;
  for (;;) {
  }
}

void fault_reported(const FaultReport& report) {
  last_words = {LastWords::kValid, report};
  restart();
}

[[noreturn]] void main_returned(int /*result*/) { restart(); }

}  // extern "C"

namespace {

IndexMemory index(std::uint32_t* begin, const std::uint32_t* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

TableSlot slot(std::uint32_t* begin, const std::uint32_t* end, IndexMemory index) {
  return {begin, static_cast<std::size_t>(end - begin), index};
}

std::size_t bytes_between(const std::uint32_t* begin, const std::uint32_t* end) {
  return static_cast<std::size_t>(end - begin) * sizeof(std::uint32_t);
}

void report_last_words() {
  if (last_words.valid == LastWords::kValid) {
    node->node()->announce(flexcomp::kRestartCode, last_words.report.program_counter);
  }
  last_words.valid = 0;
}

/// Armv7-M Architecture Reference Manual, B3.2.12 and B3.3: SysTick below all other interrupts.
void start_steps() {
  constexpr std::uint32_t kLowestPriority = 0xFFU << 24U;
  constexpr std::uint32_t kEnableInterruptProcessorClock = 7;
  register_at(0xE000ED20) = register_at(0xE000ED20) | kLowestPriority;
  register_at(0xE000E014) = board::clock_frequency() / kStepsASecond - 1;
  register_at(0xE000E018) = 0;
  register_at(0xE000E010) = kEnableInterruptProcessorClock;
}

}  // namespace

int main() {
  flexcomp::cortex_m7::prepare_stack();
  NodeSettings settings;
  read_record(__settings_start, bytes_between(__settings_start, __settings_end),
              &settings);  // else they stay such that no node takes them
  static SlcanNode the_node(settings, &received, &to_send,
                            slot(__first_slot, __second_slot, index(__first_index, __second_index)),
                            slot(__second_slot, __slots_end, index(__second_index, __fixed_index)));
  node = &the_node;
  node->start_with(__table_start, bytes_between(__table_start, __table_end),
                   index(__fixed_index, __indices_end));
  report_last_words();
  board::start(&received, &to_send);
  start_steps();
  board::start_watchdog(kWatchdogTime);
  for (;;) {
    const std::uint32_t done = steps.load(std::memory_order_relaxed);
    if (done != seen.load(std::memory_order_relaxed)) {
      seen.store(done, std::memory_order_relaxed);
      node->check_table();
      node->set_stack_used(flexcomp::cortex_m7::stack_used());
    }
    asm volatile("wfi");
  }
}
