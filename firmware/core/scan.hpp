#pragma once
// Where a fit should start.

#include <algorithm>
#include <array>
#include <cstdint>

#include "firmware/core/problem.hpp"
#include "firmware/core/side_energies.hpp"
#include "firmware/core/told_start.hpp"

namespace strainfinger::firmware {

/// A scan reaches a little beyond half a pitch, where the next window takes over.
inline constexpr int kScanReach = kLastScanRow;
/// Contacts midway between two gauges are looked for from here on.
inline constexpr int kMidwayRow = 20;

/// The offset of a part of a window that explains most.
struct Peak {
  std::int32_t energy;  ///< below 0: no peak, a mere foot of a neighbour
  std::int32_t row;     ///< negative: on the - side
};

inline void raise(Peak& peak, std::int32_t energy, int row) {
  if (energy > peak.energy) peak = {energy, row};
}

/// The best offset of each side of a window, and what the sides explain beside the middle gauge.
struct Sides {
  Peak minus, plus;
  std::int32_t innerMinus, innerPlus;
};

/// Energies that the seven gauges explain with the contact at rows first, first + kMaxScanStep .. up to
/// `last`, on either side.
[[gnu::always_inline]] inline Sides scannedSides(const FitTable& rows, const Signal& signal, int first,
                                                 int last) {
  const FitRow* at = unknown(unknown(rows.data()) + first);
  // Beside the middle gauge a weak tangential load has two peaks, no matter how close: exactly, then.
  const SideEnergies inner = exactEnergies(sideParts(*at, signal));
  Sides sides{{inner.minus, -first}, {inner.plus, first}, inner.minus, inner.plus};
  for (int row = first + kMaxScanStep; row <= last; row += kMaxScanStep) {
    at = unknown(at + kMaxScanStep);
    const SideEnergies energy = roughEnergies(sideParts(*at, signal));
    raise(sides.minus, energy.minus, -row);
    raise(sides.plus, energy.plus, row);
  }
  return sides;
}

/// The two best starts of a window: one a side, but for a side that rises towards the middle and on beyond
/// it.
struct BestTwo {
  Peak first, second;
};
inline BestTwo bestTwo(const Sides& sides) {
  if (sides.minus.energy > sides.plus.energy) {
    const bool foot = sides.plus.row == kFirstScanRow && sides.plus.energy <= sides.innerMinus;
    return {sides.minus, {foot ? -1 : sides.plus.energy, sides.plus.row}};
  }
  const bool foot = sides.minus.row == -kFirstScanRow && sides.minus.energy <= sides.innerPlus;
  return {sides.plus, {foot ? -1 : sides.minus.energy, sides.minus.row}};
}

/// Within 1/32 and the noise of a window's best peak the second may win once it is refined.
inline bool mayWin(const Problem& problem, const BestTwo& peaks) {
  return peaks.second.energy > peaks.first.energy - (peaks.first.energy >> 5) - problem.noise;
}

/// A place to start a fit from.
struct Start {
  std::int32_t energy;
  std::uint8_t centre;
  std::int8_t row;
};

inline Start startAt(int centre, const Peak& peak) {
  return {peak.energy, static_cast<std::uint8_t>(centre), static_cast<std::int8_t>(peak.row)};
}

/// windowSignal(), in one place for what is not in a hurry.
Signal signalAround(const Problem& problem, int centre);

/// Where the fit of a contact starts.
struct Region {
  int centre;  ///< gauge in the middle of the window
  Signal signal;
  BestTwo peaks;
  int anchor;  ///< where the strains said that the middle should be
};
/// The gauge with the largest reading of a pressing load's sign, the first of equals.
int deepestGauge(const std::int32_t* strains_q32, int gauges, int sign);

/// The best start between kMidwayRow and the edge of a window.
Start midwayStart(const Problem& problem, int centre);

/// Finds a start where the strains bend most: within half a pitch in 94 % of contacts, within 0.6 in 99 %.
/// The others lie midway between two gauges, two or three pitches away: what explains too little is looked
/// for there, too. Scans from row `first` on.
void lookAtBend(const Problem& problem, int first, Region& region);

/// Share of the ring's energy that a single reading has, in sixteenths.
inline std::size_t shareOf(const Problem& problem, int gauge) {
  const std::int32_t reading = raised(problem.strains[static_cast<std::size_t>(gauge)], problem.up) >> 16;
  const std::int32_t own = (reading * reading) >> 2, unit = (problem.ringEnergy >> 4) + 1;
  static_assert(kShares == 16);
#if defined(__ARM_ARCH_6M__)  // without a divider
  std::int32_t share = own >= 8 * unit ? 8 : 0;
  if (own >= (share + 4) * unit) share += 4;
  if (own >= (share + 2) * unit) share += 2;
  if (own >= (share + 1) * unit) share += 1;
  return static_cast<std::size_t>(share);
#else
  return static_cast<std::size_t>(std::min<std::int32_t>(own / unit, kShares - 1));
#endif
}

/// The deepest reading: whose it is, and its share of the ring's energy in sixteenths.
struct Deepest {
  int gauge;
  std::size_t share;
};
inline Deepest deepestOf(const Problem& problem) {
  const int gauge =
      deepestGauge(problem.strains.data(), problem.gauges(), problem.tables.constants.anchor_sign);
  return {gauge, shareOf(problem, gauge)};
}

/// Finds a start: most contacts are looked for around the deepest reading and nowhere else, at two or three
/// of the five offsets of a scan (see ScanSpan).
inline void look(const Problem& problem, const Deepest& deepest, Region& region) {
  region.anchor = region.centre = deepest.gauge;
  const ScanSpan span = problem.tables.constants.scan_span[deepest.share];
  if (span.last() == 0) return lookAtBend(problem, span.first(), region);
  region.signal = windowSignal(problem.strains, region.centre, problem.up);
  region.peaks = bestTwo(scannedSides(problem.tables.rows, region.signal, span.first(), span.last()));
}

inline const StartWeights& startWeights(const Problem& problem, const Deepest& deepest) {
  return unknown(problem.tables.start.data())[deepest.share];
}

/// The row that the pairs beside a window's middle gauge tell, negative on the - side.
inline int toldRow(const StartWeights& weights, const Signal& signal) {
  const Number offset = toldOffset(weights, signal);
  const int row = nearestRow(absolute(offset) * (1 << (kPitchBits - kStartWeightBits)));
  return offset < 0 ? -row : row;
}

}  // namespace strainfinger::firmware
