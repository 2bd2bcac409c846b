#pragma once
// Gauss-Newton on place, loads and width together, and a start for it.

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/bench/methods/gauss_newton.hpp"
#include "host/bench/methods/patch_table.hpp"
#include "host/bench/methods/starts.hpp"

namespace strainfinger::bench {

template <typename Real>
struct WideMinimum {
  WidePlace<Real> contact;
  Real residual;  ///< predicted after the last step
};

/// Columns place, normal, tangential, moment; over the Gauges nearest to the place.
template <int Gauges, typename Real>
NormalEquations<Real, 4> wideEquations(const PatchTable<Real>& table, const Ring<Real>& strain,
                                       const WidePlace<Real>& contact) {
  NormalEquations<Real, 4> equations;
  const auto& [position, normal, tangential] = contact.place;
  const int nearest = static_cast<int>(position + Real{kGauges + 0.5}) - kGauges;
  for (int gauge = nearest - Gauges / 2; gauge < nearest - Gauges / 2 + Gauges; ++gauge) {
    const auto at = table.at(static_cast<Real>(gauge) - position, contact);
    const Real slope = normal * at.normal.slope + tangential * at.tangential.slope;
    const Real widening = normal * at.normal.widening + tangential * at.tangential.widening;
    const Real fitted = normal * at.normal.value + tangential * at.tangential.value;
    equations.add({-slope, at.normal.value, at.tangential.value, widening}, strain[gaugeOf(gauge)] - fitted);
  }
  return equations;
}

/// At most `steps` steps of at most a quarter of a pitch and 1/16 + 5/16 of the moment, which stays within
/// the table: where a step would leave it the others are solved for what is left.
template <int Gauges, typename Real>
WideMinimum<Real> fitWidth(const PatchTable<Real>& table, const Ring<Real>& strain, WidePlace<Real> contact,
                           int steps) {
  constexpr Real kMostTurn{0.25}, kSettledMoment{1.0 / 256};
  Real residual = std::numeric_limits<Real>::max();
  if (!(std::abs(contact.place.position_pitch) <= 2 * kGauges)) return {contact, residual};
  for (int step = 0; step < steps; ++step) {
    const auto equations = wideEquations<Gauges>(table, strain, contact);
    auto change = equations.solution();
    const Real most = Real{1} / 16 + contact.moment * 5 / 16;
    const Real widened = std::clamp(contact.moment + std::clamp(change[3], -most, most), Real{0}, Real{1});
    if (!(std::abs(change[0]) <= kGauges) || !std::isfinite(widened)) break;
    if (widened != contact.moment + change[3]) change = equations.solutionWith(widened - contact.moment);
    const Real moved = std::clamp(change[0], -kMostTurn, kMostTurn);
    contact = {{contact.place.position_pitch + moved, contact.place.normal + change[1],
                contact.place.tangential + change[2]},
               widened};
    residual = equations.residualAfter(change);
    if (std::abs(moved) < Real{kSettled_pitch} && std::abs(change[3]) < kSettledMoment) break;
  }
  return {contact, residual};
}

/// From both of the scan's places for a line, each as a narrow and as a wide contact; the possible answer
/// that leaves least unexplained.
inline Place<float> scanAndFitWidth(const PatchTable<float>& table, const ScanBank& bank,
                                    const Ring<float>& strain) {
  constexpr int kSteps = 10, kNearest = 9;
  constexpr std::array<float, 2> kMoments{0.02f, 0.25f};
  WideMinimum<float> best{{placeWithoutLoads(std::numeric_limits<float>::quiet_NaN()), 0},
                          std::numeric_limits<float>::max()};
  for (const Place<float>& start : startsOfScan(bank, strain))
    for (const float moment : kMoments) {
      const auto end = fitWidth<kNearest, float>(table, strain, {start, moment}, kSteps);
      if (isPossible(end.contact.place) && end.residual < best.residual) best = end;
    }
  return best.contact.place;
}

}  // namespace strainfinger::bench
