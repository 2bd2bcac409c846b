#include "host/model/surface_field.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "host/model/series.hpp"

namespace strainfinger::model {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = std::numeric_limits<double>::epsilon() / 16;  // of a sum, per term

/// c_0, c_1, c_2 of the response at r_b for alpha^2n -> 0: harmonic.hpp's terms with A = B = 0, b = a.
struct Asymptote {
  Vector3d normal, tangential;

  double at(int n, Traction traction) const {
    const Vector3d falls(1, 1.0 / (n - 1), 1.0 / (n + 1));
    return falls.dot(traction == kNormal ? normal : tangential);
  }
};

Asymptote asymptote(const Annulus<double>& annulus, Row row) {
  const double kappa = 3 - 4 * annulus.poisson_ratio, twoMu = 2 * annulus.shear_modulus_pa;
  const Vector3d sharp = Vector3d(0, 0.5, kappa / 2) * annulus.outer_radius_m / twoMu;
  const Vector3d blunt = Vector3d(0, 0.5, -kappa / 2) * annulus.outer_radius_m / twoMu;
  const Vector3d one = Vector3d::UnitX(), none = Vector3d::Zero();
  switch (row) {
    case kTrr:
      return {one, none};
    case kTrt:
      return {none, one};
    case kTtt:
      return {one, -2 * one};
    case kUr:
      return {sharp, blunt};
    case kUt:
      return {blunt, sharp};
    case kErr:
      return {one * (kappa - 1) / (2 * twoMu), one * (3 - kappa) / (2 * twoMu)};
    case kEtt:
      return {one * (kappa - 1) / (2 * twoMu), -one * (kappa + 1) / (2 * twoMu)};
    default:
      return {none, one / twoMu};
  }
}

/// Sums over n >= 2 of (1, 1 / (n - 1), 1 / (n + 1)) cos n t / n and sin n t / n.
struct EdgeSums {
  Vector3d cosines, sines;
};

EdgeSums edgeSums(double angle_rad) {
  const double t = std::remainder(angle_rad, 2 * std::numbers::pi);
  const double c = std::cos(t), s = std::sin(t), versine = 2 * std::pow(std::sin(t / 2), 2);
  const double tooth = t == 0 ? 0 : std::copysign((std::numbers::pi - std::abs(t)) / 2, t);
  const double log = -std::log(2 * std::abs(std::sin(t / 2)));
  const double bounded = t == 0 ? 0 : log;  // its factors vanish where the logarithm is infinite
  return {{log - c, c - bounded * versine - tooth * s, bounded * versine - tooth * s - c / 2},
          {tooth - s, bounded * s - tooth * versine + s, tooth * versine + bounded * s - s / 2}};
}

double dotFinite(const Vector3d& factors, const Vector3d& sums) {
  double dot = 0;
  for (int i = 0; i < 3; ++i)
    if (factors[i] != 0) dot += factors[i] * sums[i];
  return dot;
}

/// Sums of asymptote * sinc(n width / 2) * cos n angle and sin n angle, n >= 2: the integral over the load is
/// the difference between its edges.
Eigen::MatrixXd sumAsymptotes(const Annulus<double>& annulus, const SurfaceLoad& load,
                              std::span<const double> angles_rad, std::span<const Row> rows) {
  const LineCoefficients line(annulus, load);
  Eigen::MatrixXd result(angles_rad.size(), rows.size());
  for (Eigen::Index k = 0; k < result.rows(); ++k) {
    const double angle = angles_rad[static_cast<std::size_t>(k)] - load.centre_rad;
    const EdgeSums after = edgeSums(angle + load.width_rad / 2),
                   before = edgeSums(angle - load.width_rad / 2);
    const Vector3d even = (after.sines - before.sines) / load.width_rad;
    const Vector3d odd = (before.cosines - after.cosines) / load.width_rad;
    for (Eigen::Index i = 0; i < result.cols(); ++i) {
      const Row row = rows[static_cast<std::size_t>(i)];
      const Asymptote factors = asymptote(annulus, row);
      const bool isEven = isEvenInNormalLoad(row);
      result(k, i) = (isEven ? 1 : -1) * dotFinite(line.normal * factors.normal, isEven ? even : odd) +
                     dotFinite(line.tangential * factors.tangential, isEven ? odd : even);
    }
  }
  return result;
}

int lastReflected(double alpha) {
  int n = 2;
  while (n < kMaxHarmonics && 10.0 * n * n * std::pow(alpha, 2 * n) > kRounding) ++n;
  return n;
}

/// Harmonics 0 and 1 whole, from 2 on what the asymptote leaves.
Eigen::MatrixXd reflectedSeries(const Annulus<double>& annulus, const SurfaceLoad& load,
                                std::span<const Row> rows) {
  const HarmonicModel<double> model(annulus, annulus.outer_radius_m);
  const Windows windows{.load_rad = load.width_rad};
  Eigen::MatrixXd table(lastReflected(annulus.core_radius_m / annulus.outer_radius_m) + 1, 2 * rows.size());
  for (int n = 0; n < table.rows(); ++n) {
    const HarmonicResponse<double> response = model(n);
    for (Eigen::Index i = 0; i < table.cols(); ++i) {
      const Row row = rows[static_cast<std::size_t>(i / 2)];
      const auto traction = static_cast<Traction>(i % 2);
      const double known = n < 2 ? 0 : asymptote(annulus, row).at(n, traction);
      table(n, i) = windows.factor(n) * (response(row, traction) - known);
    }
  }
  return table;
}

}  // namespace

Eigen::MatrixXd computeSurfaceField(const Annulus<double>& annulus, const SurfaceLoad& load,
                                    std::span<const double> angles_rad, std::span<const Row> rows) {
  requireDomain(annulus, annulus.outer_radius_m, {.load_rad = load.width_rad}, kRounding);
  const Eigen::MatrixXd table = reflectedSeries(annulus, load, rows);
  return sumSeries(table, rows, annulus, load, angles_rad) + sumAsymptotes(annulus, load, angles_rad, rows);
}

}  // namespace strainfinger::model
