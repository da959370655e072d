#pragma once

#include <cstdint>

namespace flexcomp::test {

/// Counts instructions by SysTick, in QEMU with `-icount shift=6`: there every instruction takes
/// 64 ns of the board's time, and its clock of 25 MHz goes on by 1.6.
class InstructionCounter {
 public:
  InstructionCounter() {
    reload() = kMask;
    current() = 0;
    control() = kEnable | kProcessorClock;
    constexpr int kTries = 8;
    overhead_ = kMask;
    for (int i = 0; i < kTries; ++i) {
      const std::uint32_t nothing = ticks_of([] {});
      overhead_ = nothing < overhead_ ? nothing : overhead_;
    }
  }

  /// Instructions that a call of `work` takes; at most ten million.
  template <typename Work>
  std::uint32_t count(Work&& work) const {
    const std::uint32_t ticks = ticks_of(work) - overhead_;
    return (ticks * 5 + 4) / 8;
  }

 private:
  static constexpr std::uint32_t kMask = 0xFFFFFF;
  static constexpr std::uint32_t kEnable = 1;
  static constexpr std::uint32_t kProcessorClock = 4;

  /// Armv7-M Architecture Reference Manual, B3.3.
  static volatile std::uint32_t& control() { return word(0xE000E010); }
  static volatile std::uint32_t& reload() { return word(0xE000E014); }
  static volatile std::uint32_t& current() { return word(0xE000E018); }
  static volatile std::uint32_t& word(std::uint32_t address) {
    return *reinterpret_cast<volatile std::uint32_t*>(address);
  }

  template <typename Work>
  [[gnu::noinline]] static std::uint32_t ticks_of(Work&& work) {
    const std::uint32_t before = current();
    asm volatile("" ::: "memory");
    work();
    asm volatile("" ::: "memory");
    return (before - current()) & kMask;
  }

  std::uint32_t overhead_ = 0;
};

}  // namespace flexcomp::test
