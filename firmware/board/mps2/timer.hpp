#pragma once
// CMSDK APB timers (Arm Cortex-M System Design Kit TRM, DDI 0479D, 4.1): they count down at the board's 25
// MHz.

#include <cstdint>

namespace strainfinger::mps2 {

/// Base addresses and interrupt (application notes AN385 and AN386).
inline constexpr std::uintptr_t kTimer0 = 0x40000000, kTimer1 = 0x40001000;
inline constexpr unsigned kTimer1Interrupt = 9;
inline constexpr std::uint32_t kTimer_MHz = 25;

struct TimerRegisters {
  std::uint32_t volatile control;
  std::uint32_t volatile value;
  std::uint32_t volatile reload;
  std::uint32_t volatile interrupts;  ///< writing 1 clears
};

/// From a count to the next, as microseconds: what doesn't make a whole one is kept for the next time.
class MicrosecondCount {
 public:
  /// `count` counts down and wraps; domain: 171 s at most since the last call.
  constexpr std::uint32_t at(std::uint32_t count) {
    const std::uint32_t ticks = last_ - count + rest_;
    last_ = count;
    rest_ = ticks % kTimer_MHz;
    now_us_ += ticks / kTimer_MHz;
    return now_us_;
  }

 private:
  std::uint32_t last_ = 0xFFFF'FFFF;
  std::uint32_t rest_ = 0;
  std::uint32_t now_us_ = 0;
};

/// Time from timer 0. Timer 1 ends sleep() every millisecond, so that what is due is done.
class Timer {
 public:
  void start() {
    constexpr std::uint32_t kEnable = 1, kInterrupt = 8;
    registers(kTimer0).reload = 0xFFFF'FFFF;
    registers(kTimer0).value = 0xFFFF'FFFF;
    registers(kTimer0).control = kEnable;
    registers(kTimer1).reload = 1000 * kTimer_MHz - 1;
    registers(kTimer1).value = 1000 * kTimer_MHz - 1;
    registers(kTimer1).control = kEnable | kInterrupt;
  }
  std::uint32_t now_us() const noexcept { return count_.at(registers(kTimer0).value); }
  static void clearInterrupt() noexcept { registers(kTimer1).interrupts = 1; }

 private:
  static TimerRegisters& registers(std::uintptr_t address) {
    return *reinterpret_cast<TimerRegisters*>(address);
  }
  mutable MicrosecondCount count_;  // asking for the time keeps it
};

}  // namespace strainfinger::mps2
