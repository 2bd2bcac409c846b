#include "firmware/core/detect.hpp"

namespace strainfinger::firmware {

std::uint32_t gateEnergy(const TableConstants& constants, std::span<const std::int32_t> strains_q32) {
  std::uint64_t energy = 0;
  for (const std::int32_t strain : strains_q32) {
    const std::int64_t coarse = strain >> constants.gate_shift;
    energy += static_cast<std::uint64_t>(coarse * coarse);
  }
  return saturate<std::uint32_t>(energy);
}

}  // namespace strainfinger::firmware
