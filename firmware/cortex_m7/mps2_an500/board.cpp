#include "cortex_m7/board.hpp"

namespace flexcomp::cortex_m7::board {
namespace {

constexpr std::uint32_t kClock = 25'000'000;  // Hz

SlcanNode::Bytes* received_bytes = nullptr;
SlcanNode::Bytes* bytes_to_send = nullptr;

/// CMSDK APB UART, timer and watchdog (Arm Cortex-M System Design Kit, technical reference manual,
/// chapter 4).
struct Uart {
  std::uint32_t data;
  std::uint32_t state;  ///< bits: 1 sender full, 2 receiver full
  std::uint32_t control;
  std::uint32_t interrupts;  ///< pending: 1 sender, 2 receiver; cleared by writing ones
  std::uint32_t divider;
};

struct Watchdog {
  std::uint32_t load;
  std::uint32_t value;
  std::uint32_t control;
  std::uint32_t clear;
};

struct Timer {
  std::uint32_t control;
  std::uint32_t value;  ///< counts down
  std::uint32_t reload;
};

constexpr std::uint32_t kSenderFull = 1;
constexpr std::uint32_t kReceiverFull = 2;
constexpr std::uint32_t kSenderInterrupt = 1;
constexpr std::uint32_t kReceiverInterrupt = 2;
constexpr std::uint32_t kSenderVector = 1;  // the receiver's is 0

volatile Uart* uart() { return reinterpret_cast<volatile Uart*>(0x40004000); }

volatile Timer* timer() { return reinterpret_cast<volatile Timer*>(0x40000000); }

volatile Watchdog* watchdog() { return reinterpret_cast<volatile Watchdog*>(0x40008000); }

volatile std::uint32_t& interrupt_enable() {
  return *reinterpret_cast<volatile std::uint32_t*>(0xE000E100);
}

volatile std::uint32_t& interrupt_pending() {
  return *reinterpret_cast<volatile std::uint32_t*>(0xE000E200);
}

void on_received() {
  uart()->interrupts = kReceiverInterrupt;
  while ((uart()->state & kReceiverFull) != 0) {
    received_bytes->push(static_cast<std::uint8_t>(uart()->data));
  }
}

void on_sent() {
  uart()->interrupts = kSenderInterrupt;
  std::uint8_t byte = 0;
  while ((uart()->state & kSenderFull) == 0 && bytes_to_send->pop(&byte)) {
    uart()->data = byte;
  }
}

using Handler = void (*)();
[[gnu::section(".vectors.board"), gnu::used]] const Handler vectors[] = {on_received, on_sent};

}  // namespace

std::uint32_t clock_frequency() { return kClock; }

void start(SlcanNode::Bytes* received, SlcanNode::Bytes* to_send) {
  constexpr std::uint32_t kSendAndReceiveByInterrupts = 0xF;
  constexpr std::uint32_t kFastest = 16;  // 1.6 Mbit/s
  received_bytes = received;
  bytes_to_send = to_send;
  uart()->divider = kFastest;
  uart()->control = kSendAndReceiveByInterrupts;
  interrupt_enable() = 3;
  timer()->reload = 0xFFFFFFFF;
  timer()->value = 0xFFFFFFFF;
  timer()->control = 1;
}

std::int64_t elapsed() {
  constexpr std::int64_t kNanosecondsATick = 1'000'000'000 / kClock;
  static std::uint32_t before = 0xFFFFFFFF;
  const std::uint32_t now = timer()->value;
  const std::uint32_t ticks = before - now;
  before = now;
  return kNanosecondsATick * ticks;
}

void wake_sender() { interrupt_pending() = 1U << kSenderVector; }

/// The whole time to the interrupt, which goes to the handler of faults; as much again to the
/// reset.
void start_watchdog(std::uint32_t milliseconds) {
  constexpr std::uint32_t kInterruptAndReset = 3;
  watchdog()->load = kClock / 1000 * milliseconds;
  watchdog()->control = kInterruptAndReset;
}

void feed_watchdog() { watchdog()->clear = 1; }

}  // namespace flexcomp::cortex_m7::board
