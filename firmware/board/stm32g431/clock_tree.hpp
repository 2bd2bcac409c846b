#pragma once
// 170 MHz from the crystal, or from the internal oscillator when the crystal doesn't start: RM0440 chapters 5
// to 7.

#include <optional>

#include "firmware/board/stm32g431/registers/clocks.hpp"
#include "firmware/board/stm32g431/registers/flash.hpp"

namespace strainfinger::stm32g431 {

inline constexpr std::uint32_t kCore_hz = 170'000'000;     ///< processor, both peripheral buses, timers
inline constexpr std::uint32_t kCrystal_hz = 24'000'000;   ///< X3 of the Nucleo board
inline constexpr std::uint32_t kInternal_hz = 16'000'000;  ///< HSI16
inline constexpr std::uint32_t kCrystal_ppm = 100;         ///< off by at most; the usual crystal is within 50
inline constexpr std::uint32_t kInternal_ppm = 10'000;     ///< 0 .. 85 degC, DS12589
inline constexpr std::uint32_t kInternalAt30degC_ppm = 7'500;  ///< the same table

enum class ClockSource : std::uint8_t { kCrystal, kInternal };

/// How the PLL makes kCore_hz: input / divideIn * multiply / divideOut.
struct PllPlan {
  std::uint32_t input_hz, divideIn, multiply, divideOut;

  constexpr std::uint32_t reference_hz() const { return input_hz / divideIn; }
  constexpr std::uint32_t oscillator_hz() const { return reference_hz() * multiply; }
  constexpr std::uint32_t output_hz() const { return oscillator_hz() / divideOut; }
  /// Limits of voltage range 1 in boost mode, DS12589, PLL characteristics.
  constexpr bool isAllowed() const {
    return input_hz % divideIn == 0 && reference_hz() >= 2'660'000 && reference_hz() <= 16'000'000 &&
           oscillator_hz() >= 96'000'000 && oscillator_hz() <= 344'000'000 && output_hz() <= 170'000'000;
  }
};

inline constexpr PllPlan kPllFromCrystal{kCrystal_hz, 6, 85, 2};
inline constexpr PllPlan kPllFromInternal{kInternal_hz, 4, 85, 2};
static_assert(kPllFromCrystal.isAllowed() && kPllFromCrystal.output_hz() == kCore_hz);
static_assert(kPllFromInternal.isAllowed() && kPllFromInternal.output_hz() == kCore_hz);

/// Wait states at kCore_hz in boost mode: one for each 34 MHz begun, less one (RM0440 section 5.3.3).
inline constexpr std::uint32_t kWaitStates = (kCore_hz + 34'000'000 - 1) / 34'000'000 - 1;
static_assert(kWaitStates == 4);

/// Each wait is bounded by polls of at least 6 cycles of the 16 MHz that run meanwhile: 3/8 us.
inline constexpr std::uint32_t kCrystalPolls = 30'000;  ///< 11 ms; a 24 MHz crystal takes about 2
inline constexpr std::uint32_t kClockPolls = 3'000;     ///< 1 ms; PLL lock takes 0.04, voltage 0.02

template <RegisterBus Bus>
class ClockTree {
 public:
  explicit ClockTree(Bus bus) : bus_(bus) {}

  /// Whatever clock runs when it is called: after a reset the internal oscillator, after the bootloader in
  /// ROM the PLL. None: a clock doesn't start or the supply doesn't settle; the processor then still runs.
  [[nodiscard]] std::optional<ClockSource> start() noexcept {
    if (!returnToInternal()) return std::nullopt;
    enableClock(bus_, Rcc::Apb1Enr1::pwr(1));
    modify(bus_, Pwr::Cr1::voltageRange(1));
    if (!waitFor(bus_, Pwr::Sr2::voltageChanging, 0, kClockPolls)) return std::nullopt;
    const ClockSource source = startCrystal() ? ClockSource::kCrystal : ClockSource::kInternal;
    const bool running = source == ClockSource::kCrystal ? startPll(kPllFromCrystal, Rcc::kPllFromHse)
                                                         : startPll(kPllFromInternal, Rcc::kPllFromHsi);
    if (!running || !switchToPll()) return std::nullopt;
    feedPeripherals(source);
    return source;
  }

 private:
  /// A PLL that feeds the processor can be neither stopped nor set (RM0440 section 7.4.4).
  bool returnToInternal() noexcept {
    modify(bus_, Rcc::Cr::hsiOn(1));
    if (!waitFor(bus_, Rcc::Cr::hsiReady, 1, kClockPolls)) return false;
    modify(bus_, Rcc::Cfgr::systemClock(Rcc::kHsi));
    return waitFor(bus_, Rcc::Cfgr::systemClockStatus, Rcc::kHsi, kClockPolls);
  }

  /// From when it is ready the crystal is watched: if it stops, the processor goes on with the internal
  /// oscillator and gets an NMI (RM0440 section 7.2.9).
  bool startCrystal() noexcept {
    modify(bus_, Rcc::Cr::hseOn(1) | Rcc::Cr::clockSecurity(1));
    if (waitFor(bus_, Rcc::Cr::hseReady, 1, kCrystalPolls)) return true;
    modify(bus_, Rcc::Cr::hseOn(0));
    return false;
  }

  bool startPll(const PllPlan& plan, Rcc::PllSource source) noexcept {
    using PllCfgr = Rcc::PllCfgr;
    modify(bus_, Rcc::Cr::pllOn(0));
    if (!waitFor(bus_, Rcc::Cr::pllReady, 0, kClockPolls)) return false;
    write(bus_, PllCfgr::source(source) | PllCfgr::divideIn(plan.divideIn - 1) |
                    PllCfgr::multiply(plan.multiply) | PllCfgr::divideOut(plan.divideOut / 2 - 1) |
                    PllCfgr::outputOn(1));
    modify(bus_, Rcc::Cr::pllOn(1));
    return waitFor(bus_, Rcc::Cr::pllReady, 1, kClockPolls);
  }

  /// The order of RM0440 section 6.1.5 for going above 150 MHz: half speed for at least 1 us on the way.
  bool switchToPll() noexcept {
    modify(bus_, Rcc::Cfgr::ahbPrescaler(Rcc::kHalf));
    modify(bus_, Pwr::Cr5::normalMode(0));
    modify(bus_, Flash::Acr::latency(kWaitStates) | Flash::Acr::prefetch(1) |
                     Flash::Acr::instructionCache(1) | Flash::Acr::dataCache(1));
    if (!waitFor(bus_, Flash::Acr::latency, kWaitStates, kClockPolls)) return false;
    modify(bus_,
           Rcc::Cfgr::systemClock(Rcc::kPll) | Rcc::Cfgr::apb1Prescaler(0) | Rcc::Cfgr::apb2Prescaler(0));
    if (!waitFor(bus_, Rcc::Cfgr::systemClockStatus, Rcc::kPll, kClockPolls)) return false;
    waitCycles<Rcc::Cfgr>(bus_, kCore_hz / 1'000'000);
    modify(bus_, Rcc::Cfgr::ahbPrescaler(Rcc::kWhole));
    return true;
  }

  /// CAN takes the crystal itself: all bit rates divide it. The converters take the system clock.
  void feedPeripherals(ClockSource source) noexcept {
    const auto fdcan = source == ClockSource::kCrystal ? Rcc::kFdcanFromHse : Rcc::kFdcanFromPclk1;
    modify(bus_, Rcc::Ccipr::fdcanClock(fdcan) | Rcc::Ccipr::adc12Clock(Rcc::kAdc12FromSystemClock));
  }

  [[no_unique_address]] Bus bus_;
};

}  // namespace strainfinger::stm32g431
