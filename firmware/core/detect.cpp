#include "firmware/core/detect.hpp"

#include "firmware/core/integer_root.hpp"

namespace strainfinger::firmware {

std::uint32_t gateEnergy(const TableConstants& constants, std::span<const std::int32_t> strains_q32) {
  std::uint64_t energy = 0;
  for (const std::int32_t strain : strains_q32) {
    const std::int64_t coarse = strain >> constants.gate_shift;
    energy += static_cast<std::uint64_t>(coarse * coarse);
  }
  return saturate<std::uint32_t>(energy);
}

std::int32_t noiseOf(const TableConstants& constants) {
  const int exponent = constants.noise_variance_exponent;
  const int odd = exponent & 1;
  const auto root = static_cast<std::int32_t>(integerRoot(constants.noise_variance << odd));
  const int up = (exponent - odd) / 2;
  return up >= 0 ? root << up : root >> -up;
}

}  // namespace strainfinger::firmware
