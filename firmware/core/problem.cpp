#include "firmware/core/problem.hpp"

#include <algorithm>
#include <bit>

namespace strainfinger::firmware {

std::int32_t noiseEnergy(const TableConstants& constants, int up) {
  constexpr std::int32_t kMost = 1 << 27;
  const std::uint32_t variances = constants.noise_variance * kNoiseUnit;  // 24 + 5 bits
  const int down = 2 * (16 - up) + 2 - constants.noise_variance_exponent;
  if (down < 2) return kMost;
  if (down > 28) return 1;
  return std::clamp<std::int32_t>(static_cast<std::int32_t>(variances >> down), 1, kMost);
}

Problem problemOf(const TableImage& tables, std::span<const std::int32_t> strains_q32, std::uint32_t energy) {
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
