#include "firmware/core/whole_scan.hpp"

namespace strainfinger::firmware {

Scan scanned(const FitTable& rows, const Signal& signal, int step) {
  const int first = step / 2, second = first + step;
  const FitRow* at = unknown(&rows[static_cast<std::size_t>(first)]);
  const SideEnergies inner = exactEnergies(sideParts(*at, signal));
  Peak minus{-1, 0}, plus{-1, 0};
  for (int row = second; row <= kScanReach; row += step) {
    at = unknown(at + step);
    const SideEnergies energy = roughEnergies(sideParts(*at, signal));
    raise(minus, energy.minus, -row);
    raise(plus, energy.plus, row);
  }
  Peak middle = inner.minus > inner.plus ? Peak{inner.minus, -first} : Peak{inner.plus, first};
  if (minus.row == -second && minus.energy <= inner.minus) minus.energy = -1;
  if (plus.row == second && plus.energy <= inner.plus) plus.energy = -1;
  if (middle.energy <= (middle.row < 0 ? minus.energy : plus.energy)) middle.energy = -1;
  return {middle, minus, plus};
}

}  // namespace strainfinger::firmware
