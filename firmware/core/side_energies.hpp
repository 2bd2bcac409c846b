#pragma once
// What a window's readings say of a contact at a row's offset, on either side of the middle gauge.

#include <cstdint>

#include "common/table_image.hpp"
#include "firmware/core/signal.hpp"

namespace strainfinger::firmware {

/// Energies of a contact at a row's offset on either side.
struct SideEnergies {
  Number minus, plus;
};

/// The parts of a signal's two projections that mirroring leaves, and those it negates: mirrored offsets
/// share their products, so that a scan costs half of what its energies would one by one.
struct SideParts {
  Number even1, even2, odd1, odd2;
};
inline SideParts sideParts(const FitRow& row, const Signal& signal) {
  return {evenPart(row.basis[0], signal), evenPart(row.basis[1], signal), oddPart(row.basis[0], signal),
          oddPart(row.basis[1], signal)};
}
inline SideEnergies exactEnergies(const SideParts& p) {
  return {energyOf(p.even1 - p.odd1, p.odd2 - p.even2), energyOf(p.even1 + p.odd1, p.even2 + p.odd2)};
}
/// Rounded to 1.5e-4 of the window's energy: enough to find where a peak is.
inline SideEnergies roughEnergies(const SideParts& p) {
  const Pair even = upperHalves(p.even1, p.even2), odd = upperHalves(p.odd1, p.odd2);
  const Pair minus = even - odd, plus = even + odd;
  return {dot(minus, minus), dot(plus, plus)};
}

}  // namespace strainfinger::firmware
