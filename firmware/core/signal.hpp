#pragma once
// The readings of one window, scaled to 16 bits and folded: what the rows of a fit table are multiplied with.

#include <array>
#include <cstdint>
#include <span>

#include "common/table_image.hpp"

namespace strainfinger::firmware {

/// Middle reading; sums of the pairs at distance 1, 2, 3; their differences (+ side minus - side); padding.
/// Not halved: FoldedWeights are, so that weights . signal is the unfolded product.
/// Domain: the window's norm before folding is below 2^14.5, so sums and differences fit 16 bits and a
/// product with weights of norm <= 1 (2^15) stays below 2^29.5, with every partial sum.
using Signal = std::array<std::int16_t, 8>;
inline constexpr std::size_t kOdd = 1 + kWindowReach;  ///< where the differences begin
inline constexpr std::size_t kEnd = 1 + 2 * kWindowReach;

/// Gauge numbers go round the ring; `gauge` is at most one turn off.
constexpr int wrapped(int gauge, int gauges) {
  if (gauge < 0) return gauge + gauges;
  return gauge >= gauges ? gauge - gauges : gauge;
}

/// A strain divided by 2^shift, rounded, saturating.
std::int16_t scaledStrain(std::int32_t strain_q32, int shift);

/// The window around gauge `centre`, strains divided by 2^shift and rounded; saturates where the norm is
/// larger than the domain allows.
Signal windowSignal(std::span<const std::int32_t> strains_q32, int centre, int shift);

/// The same readings with the ring's sense of rotation reversed; mirrorSign as in TableConstants.
Signal mirrored(const Signal& signal, int mirrorSign);

/// The part of weights . signal that mirroring leaves, and the part it negates (for mirrorSign = 1).
inline std::int32_t evenPart(const FoldedWeights& weights, const Signal& signal) {
  std::int32_t sum = 0;
  for (std::size_t k = 0; k < kOdd; ++k) sum += std::int32_t{weights[k]} * signal[k];
  return sum;
}
inline std::int32_t oddPart(const FoldedWeights& weights, const Signal& signal) {
  std::int32_t sum = 0;
  for (std::size_t k = kOdd; k < kEnd; ++k) sum += std::int32_t{weights[k]} * signal[k];
  return sum;
}

/// weights . signal [* 2^15]
inline std::int32_t project(const FoldedWeights& weights, const Signal& signal) {
  return evenPart(weights, signal) + oddPart(weights, signal);
}

/// Energies are sums of squares of scaled strains, divided by 4, which is what the high products of
/// projections are: below 2^27.
inline std::int32_t energyOf(std::int32_t projection1, std::int32_t projection2) {
  return mulHigh(projection1, projection1) + mulHigh(projection2, projection2);
}
std::int32_t energyOf(const Signal& signal);

}  // namespace strainfinger::firmware
