#pragma once
// The gauge nearest to the contact, and what a textbook makes of it and its neighbours.

#include <algorithm>

#include "host/bench/methods/sample.hpp"

namespace strainfinger::bench {

/// The gauge that is compressed most. It is not the nearest one for a fifth of the contacts.
template <typename Real>
int strongestGauge(const Ring<Real>& strain) {
  return static_cast<int>(std::min_element(strain.begin(), strain.end()) - strain.begin());
}

/// The gauge where the strains bend most: within 0.6 of a pitch for 99 % of the contacts.
template <typename Real>
int sharpestGauge(const Ring<Real>& strain) {
  int sharpest = 0;
  Real most{};
  for (int gauge = 0; gauge < kGauges; ++gauge) {
    const Real bend = strain[gaugeOf(gauge - 1)] + strain[gaugeOf(gauge + 1)] - 2 * strain[gaugeOf(gauge)];
    if (bend <= most) continue;
    most = bend;
    sharpest = gauge;
  }
  return sharpest;
}

/// Centre of gravity of the compression over the strongest gauge and its neighbours.
template <typename Real>
Place<Real> centroid(const Ring<Real>& strain) {
  const int peak = strongestGauge(strain);
  const auto weight = [&](int gauge) { return std::max(-strain[gaugeOf(gauge)], Real{}); };
  const Real before = weight(peak - 1), after = weight(peak + 1);
  return placeWithoutLoads(static_cast<Real>(peak) + (after - before) / (before + weight(peak) + after));
}

/// Vertex of the parabola through the strongest gauge and its neighbours.
template <typename Real>
Place<Real> parabola(const Ring<Real>& strain) {
  const int peak = strongestGauge(strain);
  const Real before = strain[gaugeOf(peak - 1)], after = strain[gaugeOf(peak + 1)];
  const Real bend = before + after - 2 * strain[gaugeOf(peak)];
  return placeWithoutLoads(static_cast<Real>(peak) + (before - after) / (2 * bend));
}

}  // namespace strainfinger::bench
