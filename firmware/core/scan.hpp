#pragma once
// Where a fit should start.

#include <array>
#include <cstdint>

#include "firmware/core/problem.hpp"
#include "firmware/core/signal.hpp"

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
/// beyond them on the - and + sides.
struct Scan {
  Signal signal;
  int centre;
  Peak middle, minus, plus;
  bool minusRises, plusRises;  ///< that peak is no mere foot of the middle's

  /// The middle's is no mere foot of an outer one.
  bool middleRises() const { return middle.energy > (middle.row < 0 ? minus : plus).energy; }
  const Peak& best() const {
    const Peak& outer = plus.energy >= minus.energy ? plus : minus;
    return middle.energy >= outer.energy ? middle : outer;
  }
};

/// Energy of two projections, rounded to 1.5e-4 of the window's: enough to find where a peak is.
inline std::int32_t roughEnergy(std::int32_t projection1, std::int32_t projection2) {
  const Pair halves = upperHalves(projection1, projection2);
  return dot(halves, halves);
}

/// Energies of a contact at a row's offset on either side.
struct SideEnergies {
  std::int32_t minus, plus;
};

/// Mirrored offsets share their products, so that a scan costs half of what its energies would one by one.
template <typename Energy>
SideEnergies sideEnergies(const FitRow& row, const Signal& signal, Energy energy) {
  constexpr std::int32_t kHalf = 0x8000;
  const std::int32_t even1 = evenPart(row.basis[0], signal, kHalf), odd1 = oddPart(row.basis[0], signal);
  const std::int32_t even2 = evenPart(row.basis[1], signal), odd2 = oddPart(row.basis[1], signal, kHalf);
  return {energy(even1 - odd1, odd2 - even2), energy(even1 + odd1, even2 + odd2)};
}

inline void raise(Peak& peak, std::int32_t energy, int row) {
  if (energy > peak.energy) peak = {energy, row};
}

/// Scans a window at rows First, First + Step .. up to kScanReach.
template <int First, int Step>
Scan scanned(const FitTable& rows, const Signal& signal, int centre) {
  constexpr int kSecond = First + Step;
  // Beside the middle gauge a weak tangential load has two peaks, no matter how close: exactly, then.
  const FitRow* at = unknown(&rows[First]);
  const SideEnergies inner = sideEnergies(*at, signal, [](auto u1, auto u2) { return energyOf(u1, u2); });
  Peak middle{inner.plus, First}, minus{-1, 0}, plus{-1, 0};
  raise(middle, inner.minus, -First);
#pragma GCC unroll 8
  for (int row = kSecond; row <= kScanReach; row += Step) {
    at = unknown(at + Step);
    const SideEnergies energy = sideEnergies(*at, signal, roughEnergy);
    raise(minus, energy.minus, -row);
    raise(plus, energy.plus, row);
  }
  return {signal, centre, middle, minus, plus, minus.row != -kSecond || minus.energy > inner.minus,
          plus.row != kSecond || plus.energy > inner.plus};
}

/// The window around gauge `centre`, at every step of the constants.
inline Scan scanWindow(const Problem& problem, int centre) {
  const FitTable& rows = problem.tables.rows;
  const Signal signal = windowSignal(problem.strains, centre, problem.up);
  if (problem.tables.constants.scan_step == kMinScanStep)
    return scanned<kMinScanStep / 2, kMinScanStep>(rows, signal, centre);
  return scanned<kMaxScanStep / 2, kMaxScanStep>(rows, signal, centre);
}

/// The gauge nearest to the contact, or nearly: where the strains bend most. Within half a pitch in 94 % of
/// contacts, within 0.6 in 99 %; the others lie midway between two gauges, two or three pitches away.
int bendAnchor(const Problem& problem);

}  // namespace strainfinger::firmware
