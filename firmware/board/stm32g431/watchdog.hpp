#pragma once
// hal::Watchdog on IWDG (RM0440 chapter 42) and what RCC says of the last reset (section 7.4.28).

#include "firmware/board/stm32g431/clock_tree.hpp"
#include "firmware/board/stm32g431/registers/system.hpp"
#include "hal/clock.hpp"
#include "hal/watchdog.hpp"

namespace strainfinger::stm32g431 {

/// Why the board started, and clears the flags for the next time. Power-on and brown-out set the same flag:
/// it was a brown-out if RAM kept what was in it.
[[nodiscard]] hal::ResetCause takeResetCause(const RegisterBus auto& bus, bool ramSurvived) noexcept {
  using Csr = Rcc::Csr;
  const std::uint32_t flags = bus.read(Csr::address);
  modify(bus, Csr::remove(1));
  modify(bus, Csr::remove(0));
  if (((Csr::independentWatchdog.mask | Csr::windowWatchdog.mask) & flags) != 0)
    return hal::ResetCause::kWatchdog;
  if (((Csr::software.mask | Csr::optionBytes.mask) & flags) != 0) return hal::ResetCause::kSoftware;
  if (Csr::brownOut.in(flags) != 0)
    return ramSurvived ? hal::ResetCause::kBrownOut : hal::ResetCause::kPowerOn;
  if (Csr::lowPower.in(flags) != 0) return hal::ResetCause::kUnknown;
  return Csr::pin.in(flags) != 0 ? hal::ResetCause::kPin : hal::ResetCause::kUnknown;
}

/// Contract: hal/watchdog.hpp. Once started it can't be stopped.
template <RegisterBus Bus, hal::Clock Clock>
class IndependentWatchdog {
 public:
  /// Five times what the finger calls a silent converter, 20 times the erasing of a flash page. Its
  /// oscillator is 32 kHz +-8 % (DS12589).
  static constexpr std::uint32_t kPeriod_ms = 500;

  /// It resets without a word: a firmware that isn't fed for so long had better say so and restart by itself.
  static constexpr std::uint32_t kStarved_ms = 400;

  IndependentWatchdog(Bus bus, const Clock& clock, hal::ResetCause cause)
      : bus_(bus), clock_(clock), cause_(cause), fedAt_us_(clock.now_us()) {}

  /// RM0440 section 42.3.2. It and the clock stand still while a debugger holds the processor. False: the
  /// settings didn't take, as when its oscillator doesn't run; what then watches over the firmware is
  /// isStarved().
  [[nodiscard]] bool start() noexcept {
    modify(bus_, Dbgmcu::Apb1Fzr1::stopWatchdog(1) | Dbgmcu::Apb1Fzr1::stopTim2(1));
    write(Iwdg::kStart);
    write(Iwdg::kUnlock);
    bus_.write(Iwdg::Pr::address, kDivideBy16);
    bus_.write(Iwdg::Rlr::address, kPeriod_ms * kTicksPerMs - 1);
    const bool taken = waitFor(bus_, Iwdg::Sr::updating, 0, kUpdatePolls);
    feed();
    return taken;
  }

  void feed() noexcept {
    write(Iwdg::kFeed);
    fedAt_us_ = clock_.now_us();
  }
  bool isStarved() const noexcept { return clock_.now_us() - fedAt_us_ >= kStarved_ms * 1000; }
  hal::ResetCause resetCause() const noexcept { return cause_; }

 private:
  static constexpr std::uint32_t kDivideBy16 = 2;
  static constexpr std::uint32_t kTicksPerMs = 32 / 16;
  static_assert(kPeriod_ms * kTicksPerMs <= 4096);
  static_assert(kStarved_ms * 100 < kPeriod_ms * 92);
  /// ST's driver allows an update six cycles of the slow clock after the largest prescaler, 256: 52 ms where
  /// it is slowest, 29.5 kHz. A poll takes 6 cycles of the processor's clock at least.
  static constexpr std::uint32_t kUpdate_ms = 6 * 256 * 10 / 295 + 1;
  static constexpr std::uint32_t kUpdatePolls = kCore_hz / 1000 / 6 * kUpdate_ms;

  void write(Iwdg::Key key) noexcept { bus_.write(Iwdg::Kr::address, key); }

  [[no_unique_address]] Bus bus_;
  const Clock& clock_;
  hal::ResetCause cause_;
  std::uint32_t fedAt_us_;
};

}  // namespace strainfinger::stm32g431
