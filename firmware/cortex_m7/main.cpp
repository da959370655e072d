/// The firmware: a node on a serial line. Priorities, highest first: the line's interrupts;
/// SysTick, which runs the node; this program, which checks tables and looks after the rest.
#include <atomic>

#include "cortex_m7/board.hpp"
#include "cortex_m7/fault_report.hpp"
#include "cortex_m7/stack.hpp"
#include "messages/table_trailer.hpp"

namespace {

using flexcomp::NodeSettings;
using flexcomp::Result;
using flexcomp::SlcanNode;
using flexcomp::Table;
using flexcomp::TableHeader;
using flexcomp::TableSlot;
using flexcomp::TableStore;
using flexcomp::cortex_m7::FaultReport;
namespace board = flexcomp::cortex_m7::board;

constexpr std::uint32_t kStepsASecond = 1000;
constexpr std::uint32_t kWatchdogTime = 500;   // ms: longer than a check of the largest table
constexpr std::uint32_t kErased = 0xFFFFFFFF;  // as flash is

SlcanNode::Bytes received;
SlcanNode::Bytes to_send;
SlcanNode* node = nullptr;
std::atomic<std::uint32_t> steps{0};

/// What survives a reset of the processor.
struct LastWords {
  static constexpr std::uint32_t kValid = 0x4641554C;
  std::uint32_t valid;
  FaultReport report;
};
[[gnu::section(".noinit")]] LastWords last_words;

volatile std::uint32_t& system_control(std::uint32_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}

}  // namespace

extern "C" {

extern const std::uint32_t __settings_start[];
extern const std::uint32_t __settings_end[];
extern const std::uint32_t __table_start[];
extern const std::uint32_t __table_end[];
extern std::uint32_t __first_slot[];
extern std::uint32_t __second_slot[];
extern std::uint32_t __slots_end[];

void tick() {
  static std::int64_t now = 0;
  now += board::elapsed();
  node->step(now);
  board::wake_sender();
  steps.store(steps.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

/// Armv7-M Architecture Reference Manual, B3.2.6: a reset by software.
[[noreturn]] void restart() {
  asm volatile("dsb" ::: "memory");
  system_control(0xE000ED0C) = 0x05FA0004;
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

TableSlot slot(std::uint32_t* begin, const std::uint32_t* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

/// Puts the table in flash to use, if there is one.
void use_table_in_flash() {
  const auto* const header = reinterpret_cast<const TableHeader*>(__table_start);
  if (header->magic == kErased || header->magic == 0) {
    return;
  }
  const std::size_t room =
      static_cast<std::size_t>(__table_end - __table_start) * sizeof(std::uint32_t);
  Table table;
  const Result opened = header->size <= room ? Table::open(header, header->size, &table)
                                             : Table::open(header, room, &table);
  node->node()->start_with(TableStore::kFixed, table, opened);
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
  system_control(0xE000ED20) = system_control(0xE000ED20) | kLowestPriority;
  system_control(0xE000E014) = board::clock_frequency() / kStepsASecond - 1;
  system_control(0xE000E018) = 0;
  system_control(0xE000E010) = kEnableInterruptProcessorClock;
}

void check_table() {
  const void* data = nullptr;
  std::size_t size = 0;
  if (node->table_to_check(&data, &size)) {
    Table table;
    const Result opened = Table::open(data, flexcomp::bytes_of_table(data, size), &table);
    node->table_checked(opened, table);
  }
}

}  // namespace

int main() {
  flexcomp::cortex_m7::prepare_stack();
  NodeSettings settings;
  const std::size_t room =
      static_cast<std::size_t>(__settings_end - __settings_start) * sizeof(std::uint32_t);
  read_record(__settings_start, room, &settings);  // else they stay such that no node takes them
  static SlcanNode the_node(settings, &received, &to_send, slot(__first_slot, __second_slot),
                            slot(__second_slot, __slots_end));
  node = &the_node;
  use_table_in_flash();
  report_last_words();
  board::start(&received, &to_send);
  start_steps();
  board::start_watchdog(kWatchdogTime);
  for (std::uint32_t seen = 0;;) {
    const std::uint32_t done = steps.load(std::memory_order_relaxed);
    if (done != seen) {
      board::feed_watchdog();
      seen = done;
      check_table();
      node->set_stack_used(flexcomp::cortex_m7::stack_used());
    }
    asm volatile("wfi");
  }
}
