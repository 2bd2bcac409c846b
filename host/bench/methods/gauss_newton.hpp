#pragma once
// Gauss-Newton on place and loads together, over the gauges nearest to the contact or all of them.

#include <algorithm>
#include <cmath>

#include "host/bench/methods/ring_response.hpp"

namespace strainfinger::bench {

/// About the firmware's (1/102): steps that are smaller do not matter.
inline constexpr double kSettled_pitch = 1.0 / 128;

/// J^T J and J^T r of a least-squares step, J's columns place, normal, tangential.
template <typename Real>
struct NormalEquations {
  std::array<Real, 6> matrix{};  ///< 00, 10, 11, 20, 21, 22
  std::array<Real, 3> right{};
  Real residual{};  ///< sum of squares

  void add(const std::array<Real, 3>& row, Real rest) {
    for (std::size_t i = 0, at = 0; i < 3; ++i) {
      for (std::size_t j = 0; j <= i; ++j) matrix[at++] += row[i] * row[j];
      right[i] += row[i] * rest;
    }
    residual += rest * rest;
  }

  /// By L D L^T. Not finite where the matrix is singular.
  std::array<Real, 3> solution() const {
    const auto& m = matrix;
    const Real l10 = m[1] / m[0], l20 = m[3] / m[0];
    const Real d1 = m[2] - l10 * m[1], v21 = m[4] - l20 * m[1], l21 = v21 / d1;
    const Real d2 = m[5] - l20 * m[3] - l21 * v21;
    const Real y1 = right[1] - l10 * right[0], y2 = right[2] - l20 * right[0] - l21 * y1;
    const Real x2 = y2 / d2, x1 = y1 / d1 - l21 * x2;
    return {right[0] / m[0] - l10 * x1 - l20 * x2, x1, x2};
  }
};

/// Over the Gauges nearest to the place (all of them: kGauges).
template <int Gauges, typename Real>
NormalEquations<Real> normalEquations(const RingResponse<Real>& response, const Ring<Real>& strain,
                                      const Place<Real>& place) {
  NormalEquations<Real> equations;
  const int nearest = static_cast<int>(place.position_pitch + Real{kGauges + 0.5}) - kGauges;
  for (int gauge = nearest - Gauges / 2; gauge < nearest - Gauges / 2 + Gauges; ++gauge) {
    const Response<Real> at = response.at(static_cast<Real>(gauge) - place.position_pitch);
    const Real slope = place.normal * at.normalSlope + place.tangential * at.tangentialSlope;
    const Real fitted = place.normal * at.normal + place.tangential * at.tangential;
    equations.add({-slope, at.normal, at.tangential}, strain[gaugeOf(gauge)] - fitted);
  }
  return equations;
}

template <typename Real>
struct Minimum {
  Place<Real> place;
  Real residual;  ///< predicted after the last step
};

/// At most `steps` steps of at most half a pitch, `steps` <= 20, from a start within a revolution of the
/// ring. What diverges comes back as what it became.
template <int Gauges, typename Real>
Minimum<Real> gaussNewton(const RingResponse<Real>& response, const Ring<Real>& strain, Place<Real> place,
                          int steps) {
  Real residual{};
  if (!(std::abs(place.position_pitch) <= 2 * kGauges)) return {place, residual};
  for (int step = 0; step < steps; ++step) {
    const auto equations = normalEquations<Gauges>(response, strain, place);
    const auto change = equations.solution();
    const Real moved = std::clamp(change[0], Real{-0.5}, Real{0.5});
    if (!(std::abs(moved) <= Real{0.5})) break;
    place = {place.position_pitch + moved, place.normal + change[1], place.tangential + change[2]};
    residual = equations.residual;
    for (std::size_t i = 0; i < 3; ++i) residual -= change[i] * equations.right[i];
    if (std::abs(moved) < Real{kSettled_pitch}) break;
  }
  return {place, residual};
}

}  // namespace strainfinger::bench
