/// A watchdog that is fed leaves the program alone; one that is not ends it. Ends with success when
/// both were so.
#include <cstdio>

#include "cortex_m7/board.hpp"
#include "cortex_m7/fault_report.hpp"

namespace {

flexcomp::SlcanNode::Bytes received;
flexcomp::SlcanNode::Bytes to_send;
volatile bool fed = true;

}  // namespace

extern "C" {

[[noreturn]] void main_returned(int result);

void fault_reported(const flexcomp::cortex_m7::FaultReport& report) {
  std::printf("ended at %08lx, %s\n", static_cast<unsigned long>(report.program_counter),
              fed ? "though it was fed" : "unfed");
  main_returned(fed || report.program_counter == 0 ? 1 : 0);
}

}  // extern "C"

int main() {
  namespace board = flexcomp::cortex_m7::board;
  constexpr std::int64_t kLimit = 100'000'000;  // ns
  board::start(&received, &to_send);
  board::start_watchdog(100);
  for (std::int64_t time = 0; time < 5 * kLimit; time += board::elapsed()) {
    board::feed_watchdog();
  }
  fed = false;
  for (std::int64_t time = 0; time < 5 * kLimit; time += board::elapsed()) {
  }
  std::printf("the watchdog did nothing\n");
  return 2;
}
