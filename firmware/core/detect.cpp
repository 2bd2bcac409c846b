#include "firmware/core/detect.hpp"

#include "firmware/core/packed.hpp"

namespace strainfinger::firmware {

namespace {

/// sum / 2^down, saturated; down below 32.
std::uint32_t lowered(std::uint64_t sum, int down) {
  const auto upper = static_cast<std::uint32_t>(sum >> 32), lower = static_cast<std::uint32_t>(sum);
  if (upper >> down != 0) return ~std::uint32_t{0};
  return lower >> down | upper << (31 - down) << 1;
}

}  // namespace

std::uint32_t gateEnergy(const TableConstants& constants, std::span<const std::int32_t> strains_q32) {
  static_assert(2 * kMostGateShift < 32);
  const std::int32_t* strain = strains_q32.data();
  const std::int32_t* const end = strain + strains_q32.size();
  std::uint64_t energy = 0;
  if (strains_q32.size() % 4 != 0) {
    energy += squareOf(strain[0]);
    energy += squareOf(strain[1]);
    strain += 2;
  }
  for (; strain != end; strain += 4) {
    energy += squareOf(strain[0]);
    energy += squareOf(strain[1]);
    energy += squareOf(strain[2]);
    energy += squareOf(strain[3]);
  }
  return lowered(energy, 2 * constants.gate_shift);
}

}  // namespace strainfinger::firmware
