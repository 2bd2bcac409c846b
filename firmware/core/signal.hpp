#pragma once
// The readings of one window, scaled to 16 bits and folded: what the rows of the fit table are multiplied
// with.

#include <array>
#include <cstdint>
#include <span>

#include "common/table_image.hpp"
#include "firmware/core/packed.hpp"

namespace strainfinger::firmware {

/// Middle reading and sums of the pairs at distance 1, 2, 3; their differences (+ side minus - side), and
/// that of the outer pair, 0 in rings without.
/// Not halved: FoldedWeights are, so that weights . signal is the unfolded product; the outer pair's is of
/// its difference as it is.
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
inline Number raised(Number value, int up) { return value * (1 << up); }

/// The difference of the outer pair, of readings each within +-2^29, rounded: its upper half is divided by
/// 2^(16 - up).
inline Number foldedOuter(Number minus, Number plus, int up) {
  const Number half = 0x8000 >> up;
  return raised(plus + half - minus, up);
}

/// A window's readings, from its - side to its + side and each within +-2^29, divided by 2^(16 - up) and
/// rounded after folding. `outer`: foldedOuter() or 0.
inline Signal foldedSignal(const Number* window, int up, Number outer) {
  const Number* const middle = window + kWindowReach;
  const Number half = 0x8000 >> up;
  const Number plus1 = middle[1] + half, plus2 = middle[2] + half, plus3 = middle[3] + half;
  const Number minus1 = middle[-1], minus2 = middle[-2], minus3 = middle[-3];
  return {{upperHalves(raised(*middle + half, up), raised(plus1 + minus1, up)),
           upperHalves(raised(plus2 + minus2, up), raised(plus3 + minus3, up))},
          {upperHalves(raised(plus1 - minus1, up), raised(plus2 - minus2, up)),
           upperHalves(raised(plus3 - minus3, up), outer)}};
}

/// foldedOuter() of the window around gauge `centre`. Apart, for the sake of rings without.
[[gnu::noinline]] inline Number outerAround(const Number* strains_q32, int gauges, int centre, int up) {
  const auto at = [&](int gauge) { return strains_q32[wrapped(gauge, gauges)]; };
  return foldedOuter(at(centre - kOuterReach), at(centre + kOuterReach), up);
}

/// The window around gauge `centre`.
[[gnu::always_inline]] inline Signal windowSignal(std::span<const Number> strains_q32, int centre, int up) {
  const int gauges = static_cast<int>(strains_q32.size());
  const int first = wrapped(centre - kWindowReach, gauges);
  Number outer = 0;
  if (hasOuterPair(gauges)) [[unlikely]]
    outer = outerAround(strains_q32.data(), gauges, centre, up);
  const Number* at = &strains_q32[static_cast<std::size_t>(first)];
  if (first + kWindowGauges <= gauges) return foldedSignal(at, up, outer);
  const Number* const wrappedAt = at - gauges;
  const int whole = gauges - first;  // readings until the ring is round
  std::array<Number, kWindowGauges> window;
#pragma GCC unroll 7
  for (int k = 0; k < kWindowGauges; ++k)
    window[static_cast<std::size_t>(k)] = (k < whole ? at : wrappedAt)[k];
  return foldedSignal(window.data(), up, outer);
}

/// The same readings with the ring's sense of rotation reversed; mirrorSign as in TableConstants.
inline Signal mirrored(const Signal& signal, int mirrorSign) {
  constexpr Pair kZero{};
  if (mirrorSign > 0) return {signal.even, {kZero - signal.odd[0], kZero - signal.odd[1]}};
  return {{kZero - signal.even[0], kZero - signal.even[1]}, signal.odd};
}

/// The part of weights . signal that mirroring leaves, and the part it negates (for mirrorSign = 1).
inline Number evenPart(const FoldedWeights& weights, const Signal& signal) {
  return dot(pairAt(&weights[2]), signal.even[1], dot(pairAt(&weights[0]), signal.even[0]));
}
inline Number oddPart(const FoldedWeights& weights, const Signal& signal) {
  return dot(pairAt(&weights[6]), signal.odd[1], dot(pairAt(&weights[4]), signal.odd[0]));
}

/// weights . signal [* 2^15]
inline Number project(const FoldedWeights& weights, const Signal& signal) {
  const Number even = evenPart(weights, signal);
  return dot(pairAt(&weights[6]), signal.odd[1], dot(pairAt(&weights[4]), signal.odd[0], even));
}

/// Energies are sums of squares of scaled strains, divided by 4: below 2^27.
inline Number energyOf(Number projection1, Number projection2) {
  return mulHigh(projection1, projection1) + mulHigh(projection2, projection2);
}

/// The whole window's. Sum and difference of a pair together have twice its energy, the middle reading once.
inline Number energyOf(const Signal& signal) {
  const auto& [even, odd] = signal;
  const Number middle = low(even[0]);
  const Number twice = dot(odd[1], odd[1], dot(odd[0], odd[0], dot(even[1], even[1], dot(even[0], even[0]))));
  return (twice + middle * middle) >> 3;
}

}  // namespace strainfinger::firmware
