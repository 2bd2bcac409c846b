#pragma once
// CMSDK APB watchdog (Cortex-M System Design Kit TRM, DDI 0479D, 4.5): one timeout raises the non-maskable
// interrupt, the next one resets.

#include <cstdint>

#include "hal/clock.hpp"
#include "hal/watchdog.hpp"

namespace strainfinger::mps2 {

struct WatchdogRegisters {
  std::uint32_t volatile load;
  std::uint32_t volatile value;
  std::uint32_t volatile control;
  std::uint32_t volatile clearInterrupt;
};

/// Guards the firmware in two times: the emulated processor's, in which it must not hang, and the world's, in
/// which sample sets must go through.
template <hal::Clock Clock>
class Watchdog {
 public:
  Watchdog(const Clock& clock, hal::ResetCause cause)
      : clock_(clock), fedAt_us_(clock.now_us()), cause_(cause) {}

  void feed() noexcept { fedAt_us_ = clock_.now_us(); }
  hal::ResetCause resetCause() const noexcept { return cause_; }

  /// No sample set went through for a whole period: real hardware would have reset by now.
  bool starved() const { return clock_.now_us() - fedAt_us_ >= kPeriod_us; }

  /// The firmware runs; from here on it must rest() within kHang_ticks.
  void run() {
    registers().load = kHang_ticks;
    registers().clearInterrupt = 1;  // the counter went on while it rested
    registers().control = kEnabled;
  }
  /// The firmware waits for the host, which may take its time: 343 s. Off, real hardware doesn't count, but
  /// QEMU 7.2 does, and resets at the next run() if that got to a second timeout.
  void rest() {
    registers().control = 0;
    registers().load = kLongest_ticks;
  }

 private:
  static constexpr std::uint32_t kPeriod_us = 1'000'000;
  static constexpr std::uint32_t kHang_ticks = 3 * 25'000'000;  ///< 3 s; long, for a busy machine's sake
  static constexpr std::uint32_t kLongest_ticks = 0xFFFFFFFF;
  static constexpr std::uint32_t kEnabled = 3;  ///< interrupt and reset

  static WatchdogRegisters& registers() { return *reinterpret_cast<WatchdogRegisters*>(0x40008000); }

  const Clock& clock_;
  std::uint32_t fedAt_us_;
  hal::ResetCause cause_;
};

}  // namespace strainfinger::mps2
