#include "firmware/core/problem.hpp"

#include <algorithm>
#include <bit>

namespace strainfinger::firmware {

FitTables Problem::fitTables() const {
  if (mode == FitMode::kRefined) return {&tables.refined, &tables.refined};
  return {&tables.three_point[kWithOffset], &tables.three_point[kAgainstOffset]};
}

std::int32_t Problem::noise(std::uint32_t variances) const {
  const int down = 2 * shift + 2 - tables.constants.noise_variance_exponent;
  const std::uint64_t scaled = std::uint64_t{tables.constants.noise_variance} * variances;
  const std::uint64_t energy = down >= 0 ? scaled >> std::min(down, 63) : scaled << std::min(-down, 24);
  return static_cast<std::int32_t>(std::clamp<std::uint64_t>(energy, 1, 1u << 27));
}

Problem problemOf(const TableImage& tables, FitMode mode, std::span<const std::int32_t> strains_q32,
                  std::uint32_t energy) {
  const int bits = 32 - std::countl_zero(energy);
  const int aboveGate = bits / 2 - 14;  // the gate's strains have a norm below 2^(bits / 2)
  const int down = 2 * aboveGate + 2;
  const auto ringEnergy = static_cast<std::int32_t>(down >= 0 ? energy >> down : energy << -down);
  return {tables, strains_q32, mode, tables.constants.gate_shift + aboveGate, ringEnergy};
}

}  // namespace strainfinger::firmware
