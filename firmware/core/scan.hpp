#pragma once
// Where a fit should start.

#include <array>
#include <cstdint>

#include "firmware/core/problem.hpp"
#include "firmware/core/side_energies.hpp"

namespace strainfinger::firmware {

/// A scan reaches so many rows: a little beyond half a pitch, where the next window takes over.
inline constexpr int kScanReach = 36;

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

/// Energies that the seven gauges explain with the contact at rows First, First + kMaxScanStep .. up to
/// `reach`, on either side.
template <int First>
[[gnu::always_inline]] inline Sides scannedSides(const FitTable& rows, const Signal& signal, int reach) {
  const FitRow* at = unknown(&rows[First]);
  // Beside the middle gauge a weak tangential load has two peaks, no matter how close: exactly, then.
  const SideEnergies inner = exactEnergies(sideParts(*at, signal));
  Sides sides{{inner.minus, -First}, {inner.plus, First}, inner.minus, inner.plus};
  for (int row = First + kMaxScanStep; row <= reach; row += kMaxScanStep) {
    at = unknown(at + kMaxScanStep);
    const SideEnergies energy = roughEnergies(sideParts(*at, signal));
    raise(sides.minus, energy.minus, -row);
    raise(sides.plus, energy.plus, row);
  }
  return sides;
}

/// The two best starts of a window: one a side, but for a side that rises towards the middle and on beyond it.
struct BestTwo {
  Peak first, second;
};
template <int First>
inline BestTwo bestTwo(const Sides& sides) {
  if (sides.minus.energy > sides.plus.energy) {
    const bool foot = sides.plus.row == First && sides.plus.energy <= sides.innerMinus;
    return {sides.minus, {foot ? -1 : sides.plus.energy, sides.plus.row}};
  }
  const bool foot = sides.minus.row == -First && sides.minus.energy <= sides.innerPlus;
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

/// Where the fit of a contact starts.
struct Region {
  int centre;  ///< gauge in the middle of the window
  Signal signal;
  BestTwo peaks;
  int anchor;                    ///< where the strains said that the middle should be
  bool lookedBeside = false;     ///< the windows two gauges from there were scanned ..
  std::array<Start, 2> besides;  ///< .. and explain less
};
template <int First>
[[gnu::always_inline]] inline void scanWindow(const Problem& problem, int reach, Region& region) {
  region.signal = windowSignal(problem.strains, region.centre, problem.up);
  region.peaks = bestTwo<First>(scannedSides<First>(problem.tables.rows, region.signal, reach));
}

/// The gauge with the largest reading of a pressing load's sign, the first of equals.
int deepestGauge(const std::int32_t* strains_q32, int gauges, int sign);

/// Finds a start where the strains bend most: within half a pitch in 94 % of contacts, within 0.6 in 99 %. The
/// others lie midway between two gauges, two or three pitches away: what explains too little is looked for
/// there, too.
void lookAtBend(const Problem& problem, Region& region);

/// Finds a start. The more of the ring's energy is in a single reading, the nearer is the contact to that gauge:
/// most contacts are looked for there and nowhere else, at two to four of the five offsets of a scan.
inline void look(const Problem& problem, Region& region) {
  region.anchor = region.centre =
      deepestGauge(problem.strains.data(), problem.gauges(), problem.tables.constants.anchor_sign);
  const std::int32_t reading =
      raised(problem.strains[static_cast<std::size_t>(region.centre)], problem.up) >> 16;
  const std::uint32_t own = static_cast<std::uint32_t>(reading * reading) * 4;
  const std::uint32_t all = static_cast<std::uint32_t>(problem.ringEnergy) >> 11;
  if (own < all * 5243) return lookAtBend(problem, region);
  const int reach = own >= all * 26214 ? 12 : own >= all * 20316 ? 20 : 28;
  scanWindow<kMaxScanStep / 2>(problem, reach, region);
}

/// Three peaks of a window that is scanned completely: the two offsets beside the middle gauge, and what lies
/// beyond them on the - and + sides.
struct Scan {
  Peak middle, minus, plus;
};

/// Scans a window at rows First, First + Step .. up to kScanReach.
template <int First, int Step>
Scan scanned(const FitTable& rows, const Signal& signal) {
  constexpr int kSecond = First + Step;
  const FitRow* at = unknown(&rows[First]);
  const SideEnergies inner = exactEnergies(sideParts(*at, signal));
  at = unknown(at + Step);
  const SideEnergies outer = roughEnergies(sideParts(*at, signal));
  Peak minus{outer.minus, -kSecond}, plus{outer.plus, kSecond};
  for (int row = kSecond + Step; row <= kScanReach; row += Step) {
    at = unknown(at + Step);
    const SideEnergies energy = roughEnergies(sideParts(*at, signal));
    raise(minus, energy.minus, -row);
    raise(plus, energy.plus, row);
  }
  Peak middle = inner.minus > inner.plus ? Peak{inner.minus, -First} : Peak{inner.plus, First};
  if (minus.row == -kSecond && minus.energy <= inner.minus) minus.energy = -1;
  if (plus.row == kSecond && plus.energy <= inner.plus) plus.energy = -1;
  if (middle.energy <= (middle.row < 0 ? minus.energy : plus.energy)) middle.energy = -1;
  return {middle, minus, plus};
}

}  // namespace strainfinger::firmware
