#pragma once
// How noisy the untouched ring is.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "common/table_image.hpp"
#include "firmware/core/hypothesis.hpp"

namespace strainfinger::firmware {

/// Compares readings kLag sample sets apart, once in kEvery: half a period of 50 Hz hum at 1 kHz, so that hum
/// counts in full while drift and slow touches hardly do. What it finds raises the gate and the variance of
/// the readings. A comparison counts for kMostGrowth times the median of the three before at most: a touch
/// that is not told from a disturbance yet is a step or two, hum is in all of them. Cost: two instructions a
/// gauge and sample set.
class NoiseMeter {
 public:
  static constexpr int kEvery = 16;
  static constexpr int kLag = 10;
  static constexpr std::uint32_t kMostGrowth = 4;
  static constexpr int kMemory = 4;         ///< sixteen comparisons: a quarter of a second [log2]
  static constexpr int kNoisy_q4 = 4 << 4;  ///< variance, in configured ones, from which the ring is noisy

  /// One sample set of an untouched ring. `gauges`: those that work; the others' noise is nobody's.
  void take(const TableConstants& constants, std::span<const std::int32_t> strains_q32, GaugeSet gauges) {
    if (phase_ == 0) {
      std::copy(strains_q32.begin(), strains_q32.end(), before_q32_.begin());
      compared_ = gauges;
    }
    if (phase_ == kLag) compare(constants, strains_q32, compared_ & gauges);
    phase_ = static_cast<std::uint8_t>((phase_ + 1) % kEvery);
  }
  /// The ring was touched in between: nothing to compare with.
  void interrupt() { phase_ = 0; }

  /// Variance of a reading in configured ones [* 2^4], at least 1.
  std::uint32_t variance_q4() const { return std::max<std::uint32_t>(mean_q8_ >> 4, 1 << 4); }
  bool isNoisy() const { return variance_q4() >= kNoisy_q4; }

 private:
  static constexpr std::uint32_t kLoudest_q8 = 1 << 24;  ///< of a comparison: readings differ no more

  void compare(const TableConstants& constants, std::span<const std::int32_t> strains_q32, GaugeSet gauges);

  std::array<std::int32_t, kMaxGauges> before_q32_{};
  GaugeSet compared_ = 0;
  std::uint32_t mean_q8_ = 1 << 8;
  std::array<std::uint32_t, 3> recent_q8_{kLoudest_q8, kLoudest_q8,
                                          kLoudest_q8};  ///< of the last comparisons
  std::uint8_t phase_ = 0;
};

}  // namespace strainfinger::firmware
