#pragma once
// The bit rates that finger.toml knows, as timings of this board's clocks.

#include <algorithm>
#include <array>

#include "firmware/board/stm32g431/bit_timing.hpp"
#include "firmware/board/stm32g431/clock_tree.hpp"

namespace strainfinger::stm32g431 {

struct CanRate {
  std::uint32_t bitRate;
  BitTiming timing;  ///< from the crystal
};

template <std::uint32_t... kBitRates>
consteval std::array<CanRate, sizeof...(kBitRates)> canRates() {
  return {CanRate{kBitRates, checkedBitTiming<kCrystal_hz, kBitRates, kCrystal_ppm>()}...};
}

inline constexpr auto kCanRates =
    canRates<10'000, 20'000, 50'000, 125'000, 250'000, 500'000, 800'000, 1'000'000>();

/// CAN FD's data phase at 2 Mbit/s, for FdcanSettings::dataTiming. None from the internal oscillator: the
/// best of its timings allows 0.69 %.
constexpr std::optional<BitTiming> fdDataTiming(ClockSource source) {
  if (source == ClockSource::kInternal) return std::nullopt;
  return checkedBitTiming<kCrystal_hz, 2'000'000, kCrystal_ppm, kDataLimits>();
}

/// None: not one of kCanRates; or, from the internal oscillator, one that is out of tolerance even at room
/// temperature (800 kbit/s: it doesn't divide the clock). What is in tolerance there may not be in the heat:
/// README.md, "Known limits".
constexpr std::optional<BitTiming> canTiming(ClockSource source, std::uint32_t bitRate) {
  const auto rate = std::ranges::find(kCanRates, bitRate, &CanRate::bitRate);
  if (rate == kCanRates.end()) return std::nullopt;
  if (source == ClockSource::kCrystal) return rate->timing;
  const std::optional<BitTiming> timing = bitTiming(kCore_hz, bitRate);
  return isInTolerance(timing, kCore_hz, bitRate, kInternalAt30degC_ppm) ? timing : std::nullopt;
}

}  // namespace strainfinger::stm32g431
