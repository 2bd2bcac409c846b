#pragma once
// Where a fit should start.

#include <algorithm>
#include <array>

#include "firmware/core/problem.hpp"
#include "firmware/core/signal.hpp"

namespace strainfinger::firmware {

/// A scan reaches so many rows: a little beyond half a pitch, where the next window takes over.
inline constexpr int kScanReach = 36;
/// Offsets on either side of the finest scan, of every fourth row.
inline constexpr int kMaxScanRows = 9;

/// Energies that the seven gauges explain with the contact at each of a row of offsets, from one side of a
/// window to the other.
struct Scan {
  Signal signal{};
  int centre = 0;
  int step = 0;     ///< rows between offsets
  int perSide = 0;  ///< offsets on either side of the middle
  std::array<std::int32_t, 2 * kMaxScanRows> energy{};
  std::uint32_t backward = 0;  ///< bit i: at offset i the tangential load points towards the middle

  int size() const { return 2 * perSide; }
  int side(int index) const { return index < perSide ? -1 : 1; }
  int row(int index) const {
    return step / 2 + step * (index < perSide ? perSide - 1 - index : index - perSide);
  }
  std::int32_t at(int index) const { return energy[static_cast<std::size_t>(index)]; }
  bool pullsBack(int index) const { return (backward >> index & 1) != 0; }
  std::int32_t best() const { return *std::max_element(energy.begin(), energy.begin() + size()); }
  bool isPeak(int index) const {
    return (index == 0 || at(index - 1) <= at(index)) && (index + 1 == size() || at(index + 1) < at(index));
  }
};

/// Scans the window around gauge `centre`. Mirrored offsets share their products, so that a scan costs half
/// of what its energies would one by one.
Scan scanWindow(const Problem& problem, int centre);

/// The gauge nearest to the contact, or nearly: where the strains bend most. Within half a pitch in 94 % of
/// contacts, within 0.6 in 99 %; the others lie midway between two gauges, two or three pitches away.
int bendAnchor(const Problem& problem);

}  // namespace strainfinger::firmware
