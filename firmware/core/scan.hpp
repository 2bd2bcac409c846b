#pragma once
// Where a fit should start.

#include <algorithm>
#include <cstdint>

#include "firmware/core/problem.hpp"
#include "firmware/core/side_energies.hpp"

namespace strainfinger::firmware {

/// A scan reaches so many rows: a little beyond half a pitch, where the next window takes over.
inline constexpr int kScanReach = 36;

/// The offset of a part of a window that explains most.
struct Peak {
  std::int32_t energy;
  std::int32_t row;  ///< negative: on the - side
};

/// Energies that the seven gauges explain with the contact at each of a row of offsets, from one side of a
/// window to the other, boiled down to three peaks: the two offsets beside the middle gauge, and what lies
/// beyond them on the - and + sides. An energy below 0: no peak, a mere foot of a neighbour.
struct Scan {
  Peak middle, minus, plus;
};

inline void raise(Peak& peak, std::int32_t energy, int row) {
  if (energy > peak.energy) peak = {energy, row};
}

/// Scans a window at rows First, First + Step .. up to kScanReach.
template <int First, int Step>
Scan scanned(const FitTable& rows, const Signal& signal) {
  constexpr int kSecond = First + Step;
  // Beside the middle gauge a weak tangential load has two peaks, no matter how close: exactly, then.
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

/// The best offset of each side of a window, and what the sides explain beside the middle gauge.
struct Sides {
  Peak minus, plus;
  std::int32_t innerMinus, innerPlus;
};

/// Scans a window at rows First, First + kMaxScanStep .. up to `reach`.
template <int First = kMaxScanStep / 2>
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

/// The two best of a scan; the second's energy is below 0 if there is one only: a side that rises towards the
/// middle and on to the other side has no peak of its own.
struct BestTwo {
  Peak first, second;
};
template <int First = kMaxScanStep / 2>
inline BestTwo bestTwo(const Sides& sides) {
  if (sides.minus.energy > sides.plus.energy) {
    const bool foot = sides.plus.row == First && sides.plus.energy <= sides.innerMinus;
    return {sides.minus, {foot ? -1 : sides.plus.energy, sides.plus.row}};
  }
  const bool foot = sides.minus.row == -First && sides.minus.energy <= sides.innerPlus;
  return {sides.plus, {foot ? -1 : sides.minus.energy, sides.minus.row}};
}

/// Where a contact is likely, and how far from there.
struct Anchor {
  int gauge;
  int reach;  ///< rows from the gauge, on either side
};
int deepestGauge(const std::int32_t* strains, int gauges, int sign);
int bendAnchor(const Problem& problem);

inline Anchor deepestAnchor(const Problem& problem) {
  const int gauge = deepestGauge(problem.strains.data(), problem.gauges(), problem.tables.constants.anchor_sign);
  const std::int32_t reading = raised(problem.strains[static_cast<std::size_t>(gauge)], problem.up) >> 16;
  const std::uint32_t own = static_cast<std::uint32_t>(reading * reading) * 4;
  const std::uint32_t all = static_cast<std::uint32_t>(problem.ringEnergy) >> 11;
  if (own >= all * 26214) return {gauge, 12};
  if (own >= all * 20316) return {gauge, 20};
  if (own >= all * 5243) return {gauge, 28};
  return {bendAnchor(problem), kScanReach};
}

/// The gauge nearest to the contact, or nearly: where the strains bend most. Within half a pitch in 94 % of
/// contacts, within 0.6 in 99 %; the others lie midway between two gauges, two or three pitches away.
int bendAnchor(const Problem& problem);

}  // namespace strainfinger::firmware
