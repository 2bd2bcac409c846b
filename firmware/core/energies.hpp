#pragma once
// Energies of readings, of noise, and of what a contact may leave outside its window: a quarter of the
// squared signal, as in signal.hpp.

#include <cstdint>

#include "firmware/core/wide.hpp"

namespace strainfinger::firmware {

/// The noise of a ring is given as the energy of so many variances of a reading.
inline constexpr std::uint32_t kNoiseUnit = 32;
inline constexpr std::int32_t kMostNoise = 1 << 27;

/// Of a reading, of 16 bits.
inline Number energyOf(Number reading) { return squareOfShort(reading) >> 2; }

/// So many variances, at least 1; `noise`: of kNoiseUnit.
inline Number energyOfVariances(Number noise, std::int32_t count) {
  static_assert(kNoiseUnit == 1 << 5);
  return Number(clamped(Wide{noise} * count >> 5, 1, kMostNoise));
}

/// The most that a contact leaves outside a window of so much; see TableConstants::tail_q16.
inline Number mostOutside(Number window, Number tail_q16) { return Number((Wide{window} * tail_q16) >> 16); }

/// Of one gauge where the rest of its window has `others`: at most 16 times that, whatever is said.
inline Number oneBeside(Number others, Number said) { return Number(lesser(said, Wide{others} * 16)); }

}  // namespace strainfinger::firmware
