#pragma once
// The bit rates that finger.toml knows, as timings of this board's clocks.

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

/// CAN FD's data phase at 2 Mbit/s, for FdcanSettings::dataTiming.
inline constexpr BitTiming kFdDataTiming =
    checkedBitTiming<kCrystal_hz, 2'000'000, kCrystal_ppm, kDataLimits>();

/// None: not one of kCanRates. From the internal oscillator the timing is the best there is, but other nodes'
/// tolerance is only kept near room temperature: README.md, "Known limits".
constexpr std::optional<BitTiming> canTiming(ClockSource source, std::uint32_t bitRate) {
  for (const CanRate& rate : kCanRates)
    if (rate.bitRate == bitRate)
      return source == ClockSource::kCrystal ? rate.timing : bitTiming(kCore_hz, bitRate);
  return std::nullopt;
}

}  // namespace strainfinger::stm32g431
