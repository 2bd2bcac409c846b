#pragma once
// Gauss-Newton on place and loads together, over the gauges nearest to the contact or all of them.

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "host/bench/methods/ring_response.hpp"

namespace strainfinger::bench {

/// About the firmware's (1/102): steps that are smaller do not matter.
inline constexpr double kSettled_pitch = 1.0 / 128;

/// J^T J and J^T r of a least-squares step, J's columns place, normal, tangential and, with four unknowns,
/// moment.
template <typename Real, std::size_t Unknowns = 3>
struct NormalEquations {
  using Vector = std::array<Real, Unknowns>;
  std::array<Vector, Unknowns> matrix{};  ///< its lower triangle
  Vector right{};
  Real residual{};  ///< sum of squares

  void add(const Vector& row, Real rest) {
    for (std::size_t i = 0; i < Unknowns; ++i) {
      for (std::size_t j = 0; j <= i; ++j) matrix[i][j] += row[i] * row[j];
      right[i] += row[i] * rest;
    }
    residual += rest * rest;
  }

  /// By L D L^T. Not finite where the matrix is singular.
  Vector solution() const {
    const Factors factors = decomposed();
    return substituted(factors, factors.forward[Unknowns - 1] / factors.diagonal[Unknowns - 1]);
  }
  /// The others' solution where the last unknown is given.
  Vector solutionWith(Real last) const { return substituted(decomposed(), last); }

  /// Sum of squares that the linear model leaves after a step.
  Real residualAfter(const Vector& step) const {
    Real rest = residual;
    for (std::size_t i = 0; i < Unknowns; ++i) {
      rest += step[i] * (step[i] * matrix[i][i] - 2 * right[i]);
      for (std::size_t j = 0; j < i; ++j) rest += 2 * step[i] * step[j] * matrix[i][j];
    }
    return rest;
  }

 private:
  struct Factors {
    std::array<Vector, Unknowns> lower{};
    Vector diagonal{}, forward{};  ///< of D; L^-1 of the right-hand side
  };

  Factors decomposed() const {
    Factors f;
    for (std::size_t i = 0; i < Unknowns; ++i) {
      f.diagonal[i] = matrix[i][i];
      f.forward[i] = right[i];
      for (std::size_t j = 0; j < i; ++j) {
        Real product = matrix[i][j];
        for (std::size_t k = 0; k < j; ++k) product -= f.lower[i][k] * f.diagonal[k] * f.lower[j][k];
        f.lower[i][j] = product / f.diagonal[j];
        f.diagonal[i] -= f.lower[i][j] * product;
        f.forward[i] -= f.lower[i][j] * f.forward[j];
      }
    }
    return f;
  }
  static Vector substituted(const Factors& f, Real last) {
    Vector x;
    x[Unknowns - 1] = last;
    for (std::size_t i = Unknowns - 1; i-- > 0;) {
      x[i] = f.forward[i] / f.diagonal[i];
      for (std::size_t j = i + 1; j < Unknowns; ++j) x[i] -= f.lower[j][i] * x[j];
    }
    return x;
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
