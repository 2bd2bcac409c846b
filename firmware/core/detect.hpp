#pragma once
// Is the finger touched, and how noisy is it while it is not?

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/table_image.hpp"
#include "firmware/core/condition.hpp"
#include "firmware/core/hypothesis.hpp"
#include "firmware/core/integers.hpp"
#include "firmware/core/units.hpp"

namespace strainfinger::firmware {

/// A sum of squared strains / 4^gate_shift, rounded down, saturating at 2^32 - 1. The sum is not negative.
inline std::uint32_t gateEnergyOf(const TableConstants& constants, std::int64_t squares) {
  static_assert(2 * kMostGateShift < 32);
  const int down = 2 * constants.gate_shift;
  const auto upper = static_cast<std::uint32_t>(squares >> 32), lower = static_cast<std::uint32_t>(squares);
  if (upper >> down != 0) return ~std::uint32_t{0};
  return lower >> down | upper << (31 - down) << 1;
}

/// Energy of a ring's strains. An even number of them, up to 32, each smaller than 2^29 (usableGain()), so
/// that the sum of their squares stays below 2^63.
inline std::uint32_t gateEnergy(const TableConstants& constants, std::span<const std::int32_t> strains_q32) {
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
  return gateEnergyOf(constants, energy);
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
/// that is not told from a disturbance yet is a step or two, hum is in all of them. A gauge that again and
/// again makes a good part of what the ring differs by from one sample set to the next, in which a touch that
/// grows changes little, is noisy by itself: the ring is measured without it. Cost: three instructions a
/// gauge and sample set.
class NoiseMeter {
 public:
  static constexpr int kEvery = 16;
  static constexpr int kLag = 10;
  static constexpr std::uint32_t kMostGrowth = 4;
  static constexpr int kMemory = 4;                   ///< sixteen comparisons: a quarter of a second [log2]
  static constexpr std::uint32_t kNoisy_q8 = 4 << 8;  ///< variance, in configured ones, of a noisy ring

  /// One sample set of an untouched ring. `gauges`: those that work; the others' noise is nobody's.
  void take(const TableConstants& constants, std::span<const std::int32_t> strains_q32, GaugeSet gauges) {
    if (phase_ == 0) {
      std::copy(strains_q32.begin(), strains_q32.end(), before_q32_.begin());
      compared_ = gauges;
    }
    if (phase_ == 1 || phase_ == kLag) compare(constants, strains_q32, compared_ & gauges);
    phase_ = static_cast<std::uint8_t>((phase_ + 1) % kEvery);
  }
  /// The ring was touched in between: nothing to compare with.
  void interrupt() { phase_ = 0; }

  /// Variance of a reading in configured ones [* 2^4], at least 1.
  std::uint32_t variance_q4() const { return std::max<std::uint32_t>(mean_q8_ >> 4, 1 << 4); }
  bool isNoisy() const { return isNoisy_; }
  /// Those that are noisy by themselves.
  GaugeSet noisyGauges() const { return noisyGauges_; }

 private:
  /// A gauge is loud in a comparison in which it makes more than so many times its share of the ring's
  /// energy, or of configured noise if that is more. Of 16 gauges, by 20,000 draws: one that is like the
  /// others in 0.5 % of comparisons, one of three times their noise in 33 %, of ten times in 76 %.
  static constexpr std::uint32_t kLoud = 6;
  /// What a comparison in which a gauge is loud counts for, and one in which it is not against: it is noisy
  /// once it is loud in more than a third of them; at ten times the others' noise after eight, while one that
  /// is like the others is not five times in a row.
  static constexpr int kLoudCounts = 8, kQuietCounts = 4, kNoisyFrom = 40, kMostCounted = 255;
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

  /// Not inlined: one set in eight needs its registers and its stack.
  [[gnu::noinline]] void compare(const TableConstants& constants, std::span<const std::int32_t> strains_q32,
                                 GaugeSet gauges) {
    if (phase_ == kLag) gauges &= ~noisyGauges_;
    Readings change;  // half of it; 0 of gauges that don't count
    for (std::size_t i = 0; i < strains_q32.size(); ++i)
      if (contains(gauges, static_cast<int>(i))) change.strain_q32[i] = (strains_q32[i] - before_q32_[i]) / 2;
    phase_ == kLag ? compareRing(constants, change) : compareGauges(constants, change);
    isNoisy_ = mean_q8_ >= kNoisy_q8 || noisyGauges_ != 0;
  }

  void compareGauges(const TableConstants& constants, const Readings& change) {
    const std::uint64_t ring = gateEnergy(constants, change.strains(constants.gauge_count));
    // Halved changes of configured noise have half the energy of the noise itself.
    const std::uint64_t energy = std::max(ring, configuredEnergy(constants) / 2);
    for (std::size_t i = 0; i < constants.gauge_count; ++i) {
      const std::uint64_t own = gateEnergyOf(constants, squareOf(change.strain_q32[i]));
      const int counts = own * constants.gauge_count > kLoud * energy ? kLoudCounts : -kQuietCounts;
      loud_[i] = static_cast<std::uint8_t>(std::clamp(loud_[i] + counts, 0, kMostCounted));
      if (loud_[i] >= kNoisyFrom) noisyGauges_ |= GaugeSet{1} << i;
      if (loud_[i] == 0) noisyGauges_ &= ~(GaugeSet{1} << i);
    }
  }

  void compareRing(const TableConstants& constants, const Readings& change) {
    const std::uint64_t energy = gateEnergy(constants, change.strains(constants.gauge_count));
    const std::uint64_t ratio_q8 = (energy << 9) / configuredEnergy(constants);
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
  std::array<std::uint8_t, kMaxGauges> loud_{};  ///< how loud each gauge was lately
  GaugeSet noisyGauges_ = 0;
  GaugeSet compared_ = 0;
  std::uint32_t mean_q8_ = kConfigured_q8;
  std::array<std::uint32_t, 3> recent_q8_{kLoudest_q8, kLoudest_q8,
                                          kLoudest_q8};  ///< of the last comparisons
  std::uint8_t phase_ = 0;
  bool isNoisy_ = false;
};

}  // namespace strainfinger::firmware
