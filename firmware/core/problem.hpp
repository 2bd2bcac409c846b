#pragma once
// The readings of one contact as the locator works with them.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

#include "common/table_image.hpp"
#include "firmware/core/energies.hpp"
#include "firmware/core/window_fit.hpp"

namespace strainfinger::firmware {

/// Which gauges a fit looks at once the neighbours have decided where it starts.
enum class FitMode : std::uint8_t {
  kThreePoint,  ///< three well-conditioned readings, as the paper concludes
  kRefined,     ///< all seven of the window
};

/// Energies here are sums of squares of strains / 2^(16 - up), divided by 4 (see signal.hpp). Differences of
/// explained energies are differences of log-likelihood, in units of half a variance.
struct Problem {
  const TableImage& tables;
  std::span<const std::int32_t> strains;  ///< [* 2^32], one a gauge
  int up;                                 ///< brings the ring's norm just below 2^(16 + 14.5)
  std::int32_t ringEnergy;                ///< of all gauges
  std::int32_t noise;                     ///< kNoiseUnit variances of a reading, 1 .. 2^27

  /// So many variances of a reading as an energy, at least 1.
  std::int32_t variances(std::int32_t count) const { return energyOfVariances(noise, count); }
  /// See mostOutside().
  std::int32_t tail_q16() const { return tables.constants.tail_q16; }

  int mirrorSign() const { return tables.constants.mirror_sign; }
  int gauges() const { return tables.constants.gauge_count; }
};

/// kNoiseUnit variances of a reading divided by 2^(16 - up), as an energy; from 1 to 2^27.
inline std::int32_t noiseEnergy(const TableConstants& constants, int up) {
  const std::uint32_t variances = constants.noise_variance * kNoiseUnit;  // 24 + 5 bits
  const int down = 2 * (16 - up) + 2 - constants.noise_variance_exponent;
  if (down < 2) return kMostNoise;
  if (down > 28) return 1;
  return std::max<std::int32_t>(static_cast<std::int32_t>(variances >> down), 1);
}

/// `energy`: gateEnergy() of the strains.
inline Problem problemOf(const TableImage& tables, std::span<const std::int32_t> strains_q32,
                         std::uint32_t energy) {
  // A little more than the energy, so that sums of two readings stay in 16 bits once they are rounded.
  const std::uint32_t half = (energy >> 1) + (energy >> 12) + 1;
  const int bits = 33 - std::countl_zero(half);
  const int aboveGate = bits / 2 - 14;  // the gate's strains have a norm below 2^(bits / 2)
  const int down = 2 * aboveGate + 2;
  const auto ringEnergy = static_cast<std::int32_t>(down >= 0 ? energy >> down : energy << -down);
  const int up = 16 - tables.constants.gate_shift - aboveGate;
  return {tables, strains_q32, up, ringEnergy, noiseEnergy(tables.constants, up)};
}

}  // namespace strainfinger::firmware
