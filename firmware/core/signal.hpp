#pragma once
// The readings of one window, scaled to 16 bits and folded: what the rows of the fit table are multiplied
// with.

#include <array>
#include <cstdint>
#include <span>

#include "common/table_image.hpp"
#include "firmware/core/packed.hpp"

namespace strainfinger::firmware {

/// Middle reading and sums of the pairs at distance 1, 2, 3; their differences (+ side minus - side), a zero.
/// Not halved: FoldedWeights are, so that weights . signal is the unfolded product.
/// Domain: the window's norm before folding is below 2^14.5, so sums and differences fit 16 bits and a
/// product with weights of norm <= 1 (2^15) stays below 2^29.5, with every partial sum.
struct Signal {
  std::array<Pair, 2> even;
  std::array<Pair, 2> odd;

  bool operator==(const Signal&) const = default;
};

/// Gauge numbers go round the ring; `gauge` is at most one turn off.
constexpr int wrapped(int gauge, int gauges) {
  if (gauge < 0) return gauge + gauges;
  return gauge >= gauges ? gauge - gauges : gauge;
}

/// Left by `up`, which may not take it out of 32 bits.
constexpr std::int32_t raised(std::int32_t value, int up) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(value) << up);
}

/// A window's readings, from its - side to its + side and each within +-2^29, divided by 2^(16 - up) and
/// rounded after folding.
inline Signal foldedSignal(const std::int32_t* window, int up) {
  const std::int32_t* const middle = window + kWindowReach;
  const std::int32_t half = 0x8000 >> up;
  const std::int32_t plus1 = middle[1] + half, plus2 = middle[2] + half, plus3 = middle[3] + half;
  const std::int32_t minus1 = middle[-1], minus2 = middle[-2], minus3 = middle[-3];
  return {{upperHalves(raised(*middle + half, up), raised(plus1 + minus1, up)),
           upperHalves(raised(plus2 + minus2, up), raised(plus3 + minus3, up))},
          {upperHalves(raised(plus1 - minus1, up), raised(plus2 - minus2, up)),
           upperHalves(raised(plus3 - minus3, up), 0)}};
}

/// The window around gauge `centre`.
inline Signal windowSignal(std::span<const std::int32_t> strains_q32, int centre, int up) {
  const int gauges = static_cast<int>(strains_q32.size());
  const int first = wrapped(centre - kWindowReach, gauges);
  const std::int32_t* at = &strains_q32[static_cast<std::size_t>(first)];
  if (first + kWindowGauges <= gauges) return foldedSignal(at, up);
  std::array<std::int32_t, kWindowGauges> window;
#pragma GCC unroll 7
  for (std::int32_t& reading : window) {
    reading = *at;
    if (++at == strains_q32.data() + gauges) at = strains_q32.data();
  }
  return foldedSignal(window.data(), up);
}

/// The same readings with the ring's sense of rotation reversed; mirrorSign as in TableConstants.
inline Signal mirrored(const Signal& signal, int mirrorSign) {
  constexpr Pair kZero{};
  if (mirrorSign > 0) return {signal.even, {kZero - signal.odd[0], kZero - signal.odd[1]}};
  return {{kZero - signal.even[0], kZero - signal.even[1]}, signal.odd};
}

/// The part of weights . signal that mirroring leaves, and the part it negates (for mirrorSign = 1).
inline std::int32_t evenPart(const FoldedWeights& weights, const Signal& signal) {
  return dot(pairAt(&weights[2]), signal.even[1], dot(pairAt(&weights[0]), signal.even[0]));
}
inline std::int32_t oddPart(const FoldedWeights& weights, const Signal& signal) {
  return dot(pairAt(&weights[6]), signal.odd[1], dot(pairAt(&weights[4]), signal.odd[0]));
}

/// weights . signal [* 2^15]
inline std::int32_t project(const FoldedWeights& weights, const Signal& signal) {
  const std::int32_t even = evenPart(weights, signal);
  return dot(pairAt(&weights[6]), signal.odd[1], dot(pairAt(&weights[4]), signal.odd[0], even));
}

/// Energies are sums of squares of scaled strains, divided by 4: below 2^27.
inline std::int32_t energyOf(std::int32_t projection1, std::int32_t projection2) {
  return mulHigh(projection1, projection1) + mulHigh(projection2, projection2);
}

/// The whole window's. Sum and difference of a pair each carry its energy twice over, together: 2 (a^2 +
/// b^2).
inline std::int32_t energyOf(const Signal& signal) {
  const std::int32_t middle = low(signal.even[0]), first = high(signal.even[0]);
  const auto square = [](Pair pair) { return static_cast<std::uint32_t>(dot(pair, pair)); };
  const std::uint32_t pairs = static_cast<std::uint32_t>(first * first) + square(signal.even[1]) +
                              square(signal.odd[0]) + square(signal.odd[1]);
  return static_cast<std::int32_t>((pairs + 2 * static_cast<std::uint32_t>(middle * middle)) >> 3);
}

}  // namespace strainfinger::firmware
