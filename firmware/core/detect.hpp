#pragma once
// Is the finger touched, and how noisy is it while it is not?

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/table_image.hpp"
#include "firmware/core/hypothesis.hpp"
#include "firmware/core/integers.hpp"
#include "firmware/core/units.hpp"

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
  static constexpr std::uint32_t kConfigured_q8 = 1 << 8;  ///< what configured noise makes of a comparison
  static constexpr std::uint32_t kLoudest_q8 = 1 << 24;    ///< of a comparison: readings differ no more

  /// What configured noise and the gate's rounding leave on average [gate energy]. Of any tables below 2^64.
  static std::uint64_t configuredEnergy(const TableConstants& constants) {
    constexpr int kMostUp = 25, kMostDown = 63;
    const int up = constants.noise_variance_exponent - 2 * constants.gate_shift;
    const std::uint64_t twice = std::uint64_t{constants.noise_variance} << 1;
    const std::uint64_t variance_q1 =
        up >= 0 ? twice << std::min(up, kMostUp) : twice >> std::min(-up, kMostDown);
    return std::max<std::uint64_t>(constants.gauge_count * (variance_q1 + 1) / 2, 1);
  }

  void compare(const TableConstants& constants, std::span<const std::int32_t> strains_q32, GaugeSet gauges) {
    std::array<std::int32_t, kMaxGauges> change;
    for (std::size_t i = 0; i < strains_q32.size(); ++i)
      change[i] = contains(gauges, static_cast<int>(i)) ? (strains_q32[i] - before_q32_[i]) / 2 : 0;
    const std::uint32_t energy = gateEnergy(constants, std::span(change).first(strains_q32.size()));
    // Halved changes of configured noise have half the energy of the noise itself.
    const std::uint64_t ratio_q8 = (std::uint64_t{energy} << 9) / configuredEnergy(constants);
    const auto now_q8 = static_cast<std::uint32_t>(std::min<std::uint64_t>(ratio_q8, kLoudest_q8));
    const auto [less_q8, more_q8] = std::minmax(recent_q8_[0], recent_q8_[1]);
    const std::uint32_t median_q8 = std::clamp(recent_q8_[2], less_q8, more_q8);
    const std::uint32_t counted_q8 = std::min(now_q8, kMostGrowth * std::max(median_q8, kConfigured_q8));
    recent_q8_ = {now_q8, recent_q8_[0], recent_q8_[1]};
    const std::int32_t change_q8 =
        static_cast<std::int32_t>(counted_q8) - static_cast<std::int32_t>(mean_q8_);
    mean_q8_ += static_cast<std::uint32_t>(change_q8 >> kMemory);
  }

  std::array<std::int32_t, kMaxGauges> before_q32_{};
  GaugeSet compared_ = 0;
  std::uint32_t mean_q8_ = kConfigured_q8;
  std::array<std::uint32_t, 3> recent_q8_{kLoudest_q8, kLoudest_q8,
                                          kLoudest_q8};  ///< of the last comparisons
  std::uint8_t phase_ = 0;
};

}  // namespace strainfinger::firmware
