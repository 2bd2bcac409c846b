#pragma once
// Is the finger touched, and how noisy is it while it is not?

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "common/table_image.hpp"
#include "firmware/core/hypothesis.hpp"
#include "firmware/core/integers.hpp"
#include "firmware/core/units.hpp"

namespace strainfinger::firmware {

/// A sum of squares of strains / 4^gate_shift, rounded down, saturating at 2^32 - 1.
inline std::uint32_t gateEnergy(const TableConstants& constants, std::int64_t sumOfSquares) {
  static_assert(2 * kMostGateShift < 32);
  const int down = 2 * constants.gate_shift;
  const auto upper = static_cast<std::uint32_t>(sumOfSquares >> 32),
             lower = static_cast<std::uint32_t>(sumOfSquares);
  if (upper >> down != 0) return ~std::uint32_t{0};
  return lower >> down | upper << (31 - down) << 1;
}

/// Energy of a ring's strains: an even number of them, up to 32, each smaller than 2^29 (usableGain()), so
/// that the sum stays below 2^63.
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
  return gateEnergy(constants, energy);
}

inline std::uint32_t gateEnergy(const TableConstants& constants, std::span<const std::int32_t> strains_q32,
                                GaugeSet gauges) {
  std::int64_t energy = 0;
  for (std::size_t i = 0; i < strains_q32.size(); ++i)
    if (contains(gauges, static_cast<int>(i))) energy += squareOf(strains_q32[i]);
  return gateEnergy(constants, energy);
}

/// Standard deviation of a reading [strain * 2^32], within 0.1 %.
inline std::int32_t readingNoise_q32(const TableConstants& constants) {
  const int exponent = constants.noise_variance_exponent;
  const int odd = exponent & 1;
  const auto root = static_cast<std::int32_t>(integerRoot(constants.noise_variance << odd));
  const int up = (exponent - odd) / 2;
  return up >= 0 ? root << up : root >> -up;
}

/// A contact begins at an energy that noise alone reaches once in 10^9 samples, and ends below one that it
/// reaches once in a thousand: the hysteresis keeps a weak touch from flickering.
class ContactGate {
 public:
  bool touched() const { return touched_; }
  /// `variance_q4`: the noise's variance over the configured one [* 2^4], at least 1.
  bool update(const TableConstants& constants, std::uint32_t energy,
              std::uint32_t variance_q4 = kConfiguredNoise_q4) {
    const std::uint32_t gate = touched_ ? constants.gate_off : constants.gate_on;
    touched_ = std::uint64_t{energy} << 4 >= std::uint64_t{gate} * variance_q4;
    return touched_;
  }

 private:
  bool touched_ = false;
};

/// Measures the noise of the untouched ring. Once in a round of kEvery sample sets it compares readings kLag
/// sets apart: at 1 kHz half a period of 50 Hz hum, so that hum counts in full, but drift and slow touches
/// hardly. The result raises the gate and the variance of the readings. A comparison counts for at most
/// kMostGrowth times the median of the three before it: a touch that is not reported shows in few
/// comparisons, when it begins or ends, while hum shows in all.
///
/// Twice in a round it looks for a gauge that is noisy by itself. A gauge with a good part of the whole
/// ring's energy is looked at in the next three sets, too. Noise is rough from set to set, while hum, and
/// touches that tap or tremble at up to a tenth of the sample rate, are smooth; and noise is now above the
/// zero and now below, while a contact pushes one way. The ring's noise is measured without noisy gauges.
class NoiseMeter {
 public:
  static constexpr int kEvery = 16;
  static constexpr int kLag = 10;
  static constexpr std::uint32_t kMostGrowth = 4;
  static constexpr int kMemory = 4;  ///< [log2] comparisons in the mean: a quarter of a second
  static constexpr std::uint32_t kNoisy_q8 = 4 << 8;  ///< variance, over the configured one, of a noisy ring

  /// One sample set of an untouched ring. `gauges`: those that work; only their noise counts. `mayBeContact`:
  /// this may be a touch, so the set is not compared, but noisy gauges are looked for.
  void take(const TableConstants& constants, std::span<const std::int32_t> strains_q32, GaugeSet gauges,
            bool mayBeContact = false) {
    if (!mayBeContact && (kBusyPhases >> phase_ & 1) == 0)
      ++phase_;
    else
      phase_ = attend(constants, strains_q32, gauges, mayBeContact);
  }
  /// The ring was touched in between: there is no set left to compare with.
  void interrupt() { phase_ = 0; }

  /// The noise's variance over the configured one [* 2^4], at least 1.
  std::uint32_t variance_q4() const { return std::max(mean_q8_ >> 4, kConfiguredNoise_q4); }
  bool isNoisy() const { return mean_q8_ >= kNoisy_q8 || noisyGauges_ != 0; }
  GaugeSet noisyGauges() const { return noisyGauges_; }

 private:
  /// Phases: those of a round, and three more in which a loud gauge is looked at before the round goes on.
  static constexpr int kLookCloser = kEvery, kMostPhases = kEvery + 3;
  static constexpr std::uint32_t kBusyPhases = 1 | 1 << kLag | 1 << (kEvery - 1) | 7 << kLookCloser;

  /// A gauge is loud in a set in which its energy is more than kLoud times its share of the ring's, or of
  /// configured noise if that is more: with 16 gauges, from three standard deviations of the others on.
  static constexpr std::uint32_t kLoud = 6;
  /// A gauge's loudness rises by kTurns when it is loud, rough, and of another sign than when it last was so.
  /// It falls by kCalms when the gauge is not loud, or smooth. From kNoisyFrom on the gauge is noisy and its
  /// loudness kLoudest. It stays noisy until that is down to 0, a second later, so that it does not come and
  /// go. Of 16 gauges with codes of 12 bits one of ten times the others' noise is named after 90 sets in the
  /// mean, one of four times after 2,400, one of twice theirs not in 10,000 (GaugeFaultTest).
  static constexpr int kTurns = 8, kCalms = 2, kNoisyFrom = 24, kLoudest = 255;
  static constexpr int kRoughBits = 4;  ///< lowest bits of a strain, dropped for third differences
  static constexpr std::uint32_t kConfigured_q8 = 1 << 8;  ///< result of a comparison with configured noise
  static constexpr std::uint32_t kLoudest_q8 = 1 << 24;    ///< largest result of a comparison

  /// Mean gate energy of configured noise, rounding included. Below 2^64 for any tables.
  static std::uint64_t configuredEnergy(const TableConstants& constants) {
    constexpr int kMostUp = 25, kMostDown = 63;
    const int up = constants.noise_variance_exponent - 2 * constants.gate_shift;
    const std::uint64_t twice = std::uint64_t{constants.noise_variance} << 1;
    const std::uint64_t variance_q1 =
        up >= 0 ? twice << std::min(up, kMostUp) : twice >> std::min(-up, kMostDown);
    return std::max<std::uint64_t>(constants.gauge_count * (variance_q1 + 1) / 2, 1);
  }

  /// Looks at the set of a busy phase; returns the next phase.
  std::uint8_t attend(const TableConstants& constants, std::span<const std::int32_t> strains_q32,
                      GaugeSet gauges, bool mayBeContact) {
    if (phase_ >= kLookCloser) return lookCloser(strains_q32);
    const auto next = static_cast<std::uint8_t>(mayBeContact ? phase_ : (phase_ + 1) % kEvery);
    if (phase_ == 0 && !mayBeContact) {
      std::copy(strains_q32.begin(), strains_q32.end(), before_q32_.begin());
      compared_ = gauges;
      return next;
    }
    const GaugeSet loud = loudGauges(constants, strains_q32, gauges);
    if (phase_ == kLag && !mayBeContact) compare(constants, strains_q32, compared_ & gauges & ~suspects());
    if (loud == 0) return next;
    choose(constants, strains_q32, gauges, loud);
    resume_ = next;
    return kLookCloser;
  }

  GaugeSet loudGauges(const TableConstants& constants, std::span<const std::int32_t> strains_q32,
                      GaugeSet gauges) {
    const std::int64_t limit = loudFrom(constants, strains_q32, gauges & ~noisyGauges_);
    GaugeSet loud = 0;
    for (std::size_t i = 0; i < strains_q32.size(); ++i) {
      if (contains(gauges, static_cast<int>(i)) && squareOf(strains_q32[i]) > limit)
        loud |= GaugeSet{1} << i;
      else if (loudness_[i] != 0)
        quieten(i);
    }
    return loud;
  }

  /// Square of a strain above which a gauge is loud in a ring of these gauges. Below 2^60.
  static std::int64_t loudFrom(const TableConstants& constants, std::span<const std::int32_t> strains_q32,
                               GaugeSet gauges) {
    const std::uint64_t ring = gateEnergy(constants, strains_q32, gauges);
    const auto energy = static_cast<std::uint32_t>(std::min<std::uint64_t>(
        std::max(ring, configuredEnergy(constants)), std::numeric_limits<std::uint32_t>::max()));
    return std::int64_t{kLoud} * (energy / constants.gauge_count + 1) << 2 * constants.gate_shift;
  }

  /// Gauges that were found rough, with alternating signs, more than once lately.
  GaugeSet suspects() const {
    GaugeSet suspects = 0;
    for (std::size_t i = 0; i < loudness_.size(); ++i)
      if (loudness_[i] > kTurns) suspects |= GaugeSet{1} << i;
    return suspects;
  }

  /// Chooses one of the loud gauges, each in turn, to be looked at in the next sets.
  void choose(const TableConstants& constants, std::span<const std::int32_t> strains_q32, GaugeSet gauges,
              GaugeSet loud) {
    constexpr std::int64_t kRough = 2 * (1 + 9 + 9 + 1);  // twice the variance of a third difference
    const GaugeSet after = loud & ~((GaugeSet{2} << chosen_) - 1);
    chosen_ = static_cast<std::uint8_t>(std::countr_zero(after != 0 ? after : loud));
    const GaugeSet others = gauges & ~noisyGauges_ & ~(GaugeSet{1} << chosen_);
    const std::int64_t loudAlone = loudFrom(constants, strains_q32, others) >> 2 * kRoughBits;
    thirdDifference_q28_ = strains_q32[chosen_] >> kRoughBits;
    isNegative_ = thirdDifference_q28_ < 0;
    smooth_ = std::max(squareOf(thirdDifference_q28_), kRough * loudAlone);
  }

  /// Returns the next phase. A gauge that may be noisy is looked at again with the next set.
  std::uint8_t lookCloser(std::span<const std::int32_t> strains_q32) {
    constexpr std::array kFactors{-3, 3, -1};
    thirdDifference_q28_ += kFactors[index(phase_ - kLookCloser)] * (strains_q32[chosen_] >> kRoughBits);
    if (phase_ + 1 < kMostPhases) return static_cast<std::uint8_t>(phase_ + 1);
    const GaugeSet gauge = GaugeSet{1} << chosen_;
    const bool wasNegative = (wasNegative_ & gauge) != 0;
    if (squareOf(thirdDifference_q28_) <= smooth_) {
      quieten(chosen_);
    } else if (isNegative_ != wasNegative) {
      wasNegative_ ^= gauge;
      const bool wasNoisy = (noisyGauges_ & gauge) != 0;
      const int loudness = loudness_[chosen_] + kTurns;
      const bool isNoisy = wasNoisy || loudness >= kNoisyFrom;
      loudness_[chosen_] = static_cast<std::uint8_t>(isNoisy ? kLoudest : loudness);
      if (isNoisy) noisyGauges_ |= gauge;
      if (!wasNoisy) return kEvery - 1;
    }
    return resume_;
  }

  void quieten(std::size_t gauge) {
    loudness_[gauge] = static_cast<std::uint8_t>(std::max(loudness_[gauge] - kCalms, 0));
    if (loudness_[gauge] == 0) noisyGauges_ &= ~(GaugeSet{1} << gauge);
  }

  void compare(const TableConstants& constants, std::span<const std::int32_t> strains_q32, GaugeSet gauges) {
    std::int64_t halved = 0;
    for (std::size_t i = 0; i < strains_q32.size(); ++i)
      if (contains(gauges, static_cast<int>(i))) halved += squareOf((strains_q32[i] - before_q32_[i]) / 2);
    const std::uint32_t energy = gateEnergy(constants, halved);
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
  std::array<std::uint8_t, kMaxGauges> loudness_{};
  GaugeSet noisyGauges_ = 0;
  GaugeSet wasNegative_ = 0;  ///< when it was last loud and rough
  GaugeSet compared_ = 0;
  std::uint32_t mean_q8_ = kConfigured_q8;
  std::array<std::uint32_t, 3> recent_q8_{kLoudest_q8, kLoudest_q8,
                                          kLoudest_q8};  ///< of the last comparisons
  std::int64_t smooth_ = 0;         ///< the largest square of a third difference that is still smooth
  Number thirdDifference_q28_ = 0;  ///< of four readings of the chosen gauge, once they are in
  bool isNegative_ = false;         ///< the first of these readings
  std::uint8_t chosen_ = 0;         ///< the loud gauge that is looked at
  std::uint8_t phase_ = 0, resume_ = 0;
};

}  // namespace strainfinger::firmware
