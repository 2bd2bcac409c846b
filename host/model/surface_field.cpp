#include "host/model/surface_field.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "host/model/series.hpp"
#include "host/model/surface_sums.hpp"

namespace strainfinger::model {
namespace {

constexpr double kRounding = std::numeric_limits<double>::epsilon() / 16;  // of a sum, per term

double dotFinite(const Vector3<double>& factors, const Vector3<double>& sums) {
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
    const double angle =
        std::remainder(angles_rad[static_cast<std::size_t>(k)] - load.centre_rad, 2 * std::numbers::pi);
    const auto difference = edgeDifferences(angle, load.width_rad / 2, std::numbers::pi);
    const Vector3<double> even = difference.sines / load.width_rad,
                          odd = -difference.cosines / load.width_rad;
    for (Eigen::Index i = 0; i < result.cols(); ++i) {
      const Row row = rows[static_cast<std::size_t>(i)];
      const Asymptote<double> factors = asymptote(annulus, row);
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
