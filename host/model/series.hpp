#pragma once
// Fourier series over the harmonics: how many are needed, with which coefficients, and how they are summed.

#include <Eigen/Core>
#include <cmath>
#include <span>

#include "host/model/harmonic.hpp"
#include "host/model/surface_load.hpp"

namespace strainfinger::model {

/// Most harmonics a series may have: enough for depths from 5e-5 r_b on, at a tolerance of 1e-15.
inline constexpr int kMaxHarmonics = 1'000'000;

/// Harmonics that are summed before they are added to the others: rounding grows with the longer of the two
/// sums only. 400,000 harmonics as one sum cost three digits.
inline constexpr int kBlock = 512;

/// Angles [rad] over which a load is spread and a gauge averages, both uniformly; 0: a point.
struct Windows {
  double load_rad = 0;
  double gauge_rad = 0;

  /// What harmonic n is multiplied by: sinc(n load / 2) sinc(n gauge / 2).
  template <typename Scalar = double>
  Scalar factor(int n) const {
    const auto sinc = [](const Scalar& x) -> Scalar { return x == 0 ? Scalar(1) : Scalar(std::sin(x) / x); };
    return sinc(n * Scalar(load_rad) / 2) * sinc(n * Scalar(gauge_rad) / 2);
  }
};

/// Throws Failure(kUsage), naming what is wrong, unless core_radius_m <= radius_m <= outer_radius_m, the
/// windows are within 0..2 pi and 0 < tolerance < 1.
void requireDomain(const Annulus<double>& annulus, double radius_m, const Windows& windows, double tolerance);

/// Windowed responses of harmonics 0..N: row n, column 2 i + load for the i-th of `rows`.
///
/// N is the first n from which on what is left out is below `tolerance` times the root mean square, and so
/// below `tolerance` times the peak, of every series kept. What is left out is bounded by a geometric series
/// from the last harmonic, windows ignored: beyond the peak of the spectrum a harmonic is gamma^n times a
/// polynomial in n of degree two at most, so it is at most gamma (1 + 1/n)^2 times the one before.
/// Throws what requireDomain() throws, and Failure(kUsage) if it takes more than kMaxHarmonics: at r_b, where
/// nothing converges, and too close below it.
Eigen::MatrixXd truncatedSeries(const Annulus<double>& annulus, double radius_m, std::span<const Row> rows,
                                const Windows& windows, double tolerance);

/// Calls visit(n, cos n angle, sin n angle) for n = 0..last. By rotation, restarted every few steps from the
/// exact product n * angle, so the error stays at 1e-14 (double) however large n is.
template <typename Scalar, typename Visit>
void visitMultiples(Scalar angle_rad, int last, Visit visit) {
  constexpr int kSteps = 32;
  const Scalar cosine = std::cos(angle_rad), sine = std::sin(angle_rad);
  Scalar c = 1, s = 0;
  for (int n = 0; n <= last; ++n) {
    if (n % kSteps == 0) {
      const Scalar product = n * angle_rad, rest = std::fma(static_cast<Scalar>(n), angle_rad, -product);
      c = std::cos(product) - rest * std::sin(product);
      s = std::sin(product) + rest * std::cos(product);
    }
    visit(n, c, s);
    const Scalar next = c * cosine - s * sine;
    s = s * cosine + c * sine;
    c = next;
  }
}

/// Sums a table of responses (row n, column 2 i + load, as truncatedSeries() makes them) under a load: one
/// row an angle, one column each of `rows`. The load's width is in the table already. For double and long
/// double.
template <typename Scalar>
Eigen::MatrixX<Scalar> sumSeries(const Eigen::MatrixX<Scalar>& table, std::span<const Row> rows,
                                 const Annulus<double>& annulus, const SurfaceLoad& load,
                                 std::span<const double> angles_rad);

}  // namespace strainfinger::model
