#pragma once
// Is the finger touched?

#include <cstdint>
#include <span>

#include "common/table_image.hpp"
#include "firmware/core/integer_root.hpp"
#include "firmware/core/integers.hpp"

namespace strainfinger::firmware {

/// Energy of a ring's strains: the sum of their squares / 4^gate_shift, rounded down, saturating at 2^32 - 1.
/// An even number of strains, up to 32, each smaller than 2^29 (usableGain()), so that the sum stays below
/// 2^63.
inline std::uint32_t gateEnergy(const TableConstants& constants, std::span<const std::int32_t> strains_q32) {
  static_assert(2 * kMostGateShift < 32);
  const std::int32_t* strain = strains_q32.data();
  const std::int32_t* const end = strain + strains_q32.size();
  std::int64_t energy = 0;
  const auto addTwo = [&] {
    energy += squareOf(strain[0]);
    energy += squareOf(strain[1]);
    strain += 2;
  };
  if (strains_q32.size() % 4 != 0) addTwo();
  while (strain != end) {
    addTwo();
    addTwo();
  }
  const int down = 2 * constants.gate_shift;
  const auto upper = static_cast<std::uint32_t>(energy >> 32), lower = static_cast<std::uint32_t>(energy);
  if (upper >> down != 0) return ~std::uint32_t{0};
  return lower >> down | upper << (31 - down) << 1;
}

/// Standard deviation of a reading [strain * 2^32], within 0.1 %.
inline std::int32_t readingNoise_q32(const TableConstants& constants) {
  const int exponent = constants.noise_variance_exponent;
  const int odd = exponent & 1;
  const auto root = static_cast<std::int32_t>(integerRoot(constants.noise_variance << odd));
  const int up = (exponent - odd) / 2;
  return up >= 0 ? root << up : root >> -up;
}

/// A contact begins where noise alone would raise the energy once in 10^9 samples, and ends where it would
/// once in a thousand: the hysteresis keeps a weak touch from flickering.
class ContactGate {
 public:
  bool touched() const { return touched_; }
  /// `variance_q4`: of a reading, in configured ones [* 2^4], at least 1.
  bool update(const TableConstants& constants, std::uint32_t energy, std::uint32_t variance_q4 = 1 << 4) {
    const std::uint32_t gate = touched_ ? constants.gate_off : constants.gate_on;
    touched_ = std::uint64_t{energy} << 4 >= std::uint64_t{gate} * variance_q4;
    return touched_;
  }

 private:
  bool touched_ = false;
};

}  // namespace strainfinger::firmware
