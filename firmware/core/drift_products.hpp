#pragma once
// The arithmetic of zeros that follow drift (zero_tracker.hpp): all that could leave its word, no decisions.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "firmware/core/tangent_products.hpp"

namespace strainfinger::firmware {

/// Readings, below 2^29 (kMostGateShift), are summed in steps of 2^6, far below the noise of one: 256 of them
/// fit 32 bits.
inline constexpr int kSumShift = 6;
inline constexpr int kAverageShift = 2;
inline constexpr int kAveraged = 1 << (kSumShift + kAverageShift);

/// What a reading adds to a sum of kAveraged, which is their average shifted left by kAverageShift. Rounded
/// towards 0: an average is no larger than the largest reading.
inline Number summand(Number strain_q32) { return strain_q32 / (1 << kSumShift); }

/// A gauge's angle from the first [revolutions * 2^32]; `pitch_turn_q35` of 32 bits.
inline Natural turnTo(Number gauge, Natural pitch_turn_q35) { return (Natural(gauge) * pitch_turn_q35) >> 3; }

/// Sine [* 2^14], within 0.2 %: a parabola, and a second one through its error. `half`: half revolutions
/// [* 2^14], -2^14 .. 2^14 - 1.
inline Number sine_q14(Number half) {
  const Number parabola = (half * ((1 << 14) - absolute(half))) >> 12;
  return parabola + ((230 * (((parabola * absolute(parabola)) >> 14) - parabola)) >> 10);
}

/// Changes of more than the whole range saturate: the squares of three fit 63 bits. A contact that did as
/// much has moved.
[[gnu::noinline]] inline Number withinRange(Wide change) { return Number(limited(change, 1 << 30)); }

/// Components of a ring's changes along the three ways in which a contact can change its window.
struct AlongWays {
  std::array<Wide, 3> sums{};

  void add(std::size_t way, Number weight, Number change) { sums[way] += Wide{weight} * change; }
  /// Saturating.
  Three components() const {
    return {narrowed(sums[0] >> 15), narrowed(sums[1] >> 15), narrowed(sums[2] >> 15)};
  }
};

/// Products of three patterns round the ring [* 2^14] with each other and with its changes, summed over the
/// gauges; what lies along a contact's ways is taken out.
struct PatternSums {
  std::array<Wide, 6> matrix{};
  std::array<Wide, 3> right{};

  void add(const Three& pattern, Number change) {
    std::size_t k = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      right[i] += Wide{pattern[i]} * change;
      for (std::size_t j = i; j < 3; ++j) matrix[k++] += Wide{pattern[i]} * pattern[j];
    }
  }
  void takeOut(const std::array<Three, 3>& patternAlong, const Three& changeAlong) {
    std::size_t k = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t way = 0; way < 3; ++way) right[i] -= Wide{patternAlong[i][way]} * changeAlong[way];
      for (std::size_t j = i; j < 3; ++j, ++k)
        for (std::size_t way = 0; way < 3; ++way)
          matrix[k] -= Wide{patternAlong[i][way]} * patternAlong[j][way];
    }
  }
  /// The average over the gauges [* 2^24] ..
  Symmetric matrix_q24(Number gauges) const {
    Symmetric average;
    for (std::size_t k = 0; k < average.size(); ++k) average[k] = Number((matrix[k] / gauges) >> 4);
    return average;
  }
  /// .. and that of the changes, saturating.
  Three changes(Number gauges) const {
    Three average;
    for (std::size_t i = 0; i < average.size(); ++i) average[i] = narrowed((right[i] >> 14) / gauges);
    return average;
  }
};

/// What a contact has changed along one of its ways: without the drift that the patterns share there.
inline Number withoutDrift(Number along, const std::array<Three, 3>& patternAlong, std::size_t way,
                           const Three& shared) {
  Wide drift = 0;
  for (std::size_t i = 0; i < 3; ++i) drift += Wide{patternAlong[i][way]} * shared[i];
  return withinRange(Wide{along} - (drift >> 14));
}
/// A gauge's change without what a contact has done to it, with so much weight in each of its ways.
inline Number withoutContact(Number change, const Three& weights, const Three& contact) {
  Wide part = 0;
  for (std::size_t way = 0; way < 3; ++way) part += Wide{weights[way]} * contact[way];
  return withinRange(Wide{change} - (part >> 15));
}

/// A gauge's zero [code * 2^15] once it has followed by so much of a strain, which is not the least of all;
/// saturating.
inline Number followedZero(Number zero_q15, Number by_q32, Number gain) {
  const Wide codes = (Wide{by_q32} << 32) / atLeast(gain, 1);
  return Number(clamped(codes + zero_q15, 0, std::numeric_limits<std::int32_t>::max()));
}

}  // namespace strainfinger::firmware
