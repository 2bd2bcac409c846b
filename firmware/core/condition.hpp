#pragma once
// Converter codes to strains: zero, gain, saturation.

#include <array>
#include <cstdint>
#include <span>

#include "common/fixed.hpp"
#include "common/table_image.hpp"
#include "firmware/core/integers.hpp"

namespace strainfinger::firmware {

/// Left-justified 16-bit codes, one a gauge (hal/gauge_adc.hpp).
using Codes = std::span<const std::uint16_t>;

/// What turns a gauge's code into its strain. Zeros are codes * 2^15, fine enough to hold averages; gains are
/// TableConstants::reading_gain for a gauge of nominal gain.
struct Calibration {
  std::array<std::int32_t, kMaxGauges> zero_q15{};
  std::array<std::int32_t, kMaxGauges> gain{};
};

/// Every gauge at the gain that the tables have for it, the zero at mid-scale. `tables` passed
/// checkTableImage().
Calibration tabledCalibration(const TableImage& tables);

inline constexpr int kCodeBits = 15;  ///< fraction bits of a zero

/// strain * 2^32 of a code, for any code and any zero and gain that are not negative.
inline Number conditioned(Number code, Number zero, Number gain) {
  return mulHigh(code * (1 << kCodeBits) - zero, gain);
}

struct Readings {
  std::array<std::int32_t, kMaxGauges> strain_q32{};

  std::span<const std::int32_t> strains(int gauges) const {
    return std::span(strain_q32).first(static_cast<std::size_t>(gauges));
  }
};

/// strain = (code * 2^15 - zero) * gain / 2^32. Formats: 31-bit difference (both terms lie in [0, 2^31)),
/// gain below 2^31, high product rounded down: at most 1 LSB (2.3e-10) low, no overflow for any code, zero
/// and gain >= 0.
void condition(const Calibration& calibration, Codes codes, Readings& readings);

/// Bit i: gauge i is at a rail of its converter, so its strain is only a bound.
std::uint32_t saturatedGauges(const TableConstants& constants, Codes codes);

/// Averages sample sets into zeros. Nothing may touch the finger meanwhile; change() tells whether something
/// did.
class ZeroAverage {
 public:
  static constexpr int kSamples = 64;

  /// True once kSamples sets are in.
  bool add(Codes codes);
  bool complete() const { return count_ >= kSamples; }
  void writeTo(Calibration& calibration) const;
  /// Bit i: gauge i was at a rail of its converter in all of them.
  std::uint32_t gaugesAtRail(const TableConstants& constants) const;
  /// Mean strains of the second half of the sets minus those of the first half.
  Readings change(const Calibration& calibration) const;

 private:
  static constexpr int kSampleBits = 6;
  static_assert(kSamples == 1 << kSampleBits && kCodeBits >= kSampleBits);

  std::array<std::uint32_t, kMaxGauges> sum_{};
  std::array<std::uint16_t, kMaxGauges> firstHalf_{};  ///< averages, to the nearest code
  int count_ = 0;
};

}  // namespace strainfinger::firmware
