#include "firmware/core/scan.hpp"

#include <limits>

namespace strainfinger::firmware {

Scan scanWindow(const Problem& problem, int centre) {
  const TableConstants& constants = problem.tables.constants;
  Scan scan;
  scan.centre = centre;
  scan.signal = windowSignal(problem.strains, centre, problem.shift);
  scan.step = constants.scan_step;
  scan.perSide = (kScanReach - scan.step / 2) / scan.step + 1;
  for (int index = scan.perSide; index < scan.size(); ++index) {
    const auto& basis = problem.tables.refined[static_cast<std::size_t>(scan.row(index))].basis;
    const std::int32_t even1 = evenPart(basis[0], scan.signal), odd1 = oddPart(basis[0], scan.signal);
    const std::int32_t even2 = evenPart(basis[1], scan.signal), odd2 = oddPart(basis[1], scan.signal);
    const auto ahead = static_cast<std::size_t>(index);
    const auto behind = static_cast<std::size_t>(scan.size() - 1 - index);
    scan.energy[ahead] = energyOf(even1 + odd1, even2 + odd2);
    scan.energy[behind] = energyOf(even1 - odd1, even2 - odd2);
    // The second projection has the sign of the tangential load, as its own side sees it.
    if (even2 + odd2 < 0) scan.backward |= 1u << ahead;
    if ((even2 - odd2) * constants.mirror_sign < 0) scan.backward |= 1u << behind;
  }
  return scan;
}

int bendAnchor(const Problem& problem) {
  int best = 0;
  std::int64_t largest = std::numeric_limits<std::int64_t>::min();
  for (int gauge = 0; gauge < problem.gauges(); ++gauge) {
    const auto at = [&](int index) {
      return std::int64_t{problem.strains[static_cast<std::size_t>(wrapped(index, problem.gauges()))]};
    };
    const std::int64_t bend =
        (at(gauge - 1) - 2 * at(gauge) + at(gauge + 1)) * problem.tables.constants.anchor_sign;
    if (bend > largest) {
      largest = bend;
      best = gauge;
    }
  }
  return best;
}

}  // namespace strainfinger::firmware
