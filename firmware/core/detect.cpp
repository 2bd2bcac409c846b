#include "firmware/core/detect.hpp"

#include "firmware/core/packed.hpp"

namespace strainfinger::firmware {

std::uint32_t gateEnergy(const TableConstants& constants, std::span<const std::int32_t> strains_q32) {
  std::uint64_t energy = 0;
  const std::int32_t* strain = strains_q32.data();
  const std::int32_t* const end = strain + strains_q32.size();
  const auto add = [&](int count) {
    for (int i = 0; i < count; ++i) energy += squareOf(strain[i]);
    strain += count;
  };
  if (strains_q32.size() % 4 != 0) add(2);
  while (strain != end) add(4);
  return saturate<std::uint32_t>(energy >> (2 * constants.gate_shift));
}

}  // namespace strainfinger::firmware
