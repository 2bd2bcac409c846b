#include "host/model/surface_field.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "host/model/series.hpp"
#include "host/model/surface_sums.hpp"

namespace strainfinger::model {
namespace {

// Over thin rubber the series and the closed form are far larger than the displacements that they leave, so
// both are computed with digits to spare.
using Fine = long double;
using FineMatrix = Eigen::MatrixX<Fine>;

constexpr double kRounding = std::numeric_limits<double>::epsilon() / 16;  // of a sum, per term
constexpr Fine kPi = std::numbers::pi_v<Fine>;

Annulus<Fine> refined(const Annulus<double>& annulus) {
  return {annulus.core_radius_m, annulus.outer_radius_m, annulus.shear_modulus_pa, annulus.poisson_ratio};
}

Fine dotFinite(const Vector3<Fine>& factors, const Vector3<Fine>& sums) {
  Fine dot = 0;
  for (int i = 0; i < 3; ++i)
    if (factors[i] != 0) dot += factors[i] * sums[i];
  return dot;
}

/// Sums of asymptote * sinc(n width / 2) * cos n angle and sin n angle, n >= 2: the integral over the load is
/// the difference between its edges.
FineMatrix sumAsymptotes(const Annulus<double>& annulus, const SurfaceLoad& load,
                         std::span<const double> angles_rad, std::span<const Row> rows) {
  const LineCoefficients line(annulus, load);
  const Fine width = load.width_rad;
  FineMatrix result(angles_rad.size(), rows.size());
  for (Eigen::Index k = 0; k < result.rows(); ++k) {
    const Fine angle =
        std::remainder(Fine(angles_rad[static_cast<std::size_t>(k)]) - Fine(load.centre_rad), 2 * kPi);
    const auto difference = edgeDifferences<Fine>(angle, width / 2, kPi);
    const Vector3<Fine> even = difference.sines / width, odd = -difference.cosines / width;
    for (Eigen::Index i = 0; i < result.cols(); ++i) {
      const Row row = rows[static_cast<std::size_t>(i)];
      const Asymptote<Fine> factors = asymptote(refined(annulus), row);
      const bool isEven = isEvenInNormalLoad(row);
      result(k, i) = 0;  // a load that isn't there adds no infinite sum at an edge
      if (load.normal_n_per_m != 0)
        result(k, i) += (isEven ? 1 : -1) * line.normal * dotFinite(factors.normal, isEven ? even : odd);
      if (load.tangential_n_per_m != 0)
        result(k, i) += line.tangential * dotFinite(factors.tangential, isEven ? odd : even);
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
FineMatrix reflectedSeries(const Annulus<double>& annulus, const SurfaceLoad& load,
                           std::span<const Row> rows) {
  const Annulus<Fine> fine = refined(annulus);
  const HarmonicModel<Fine> model(fine, fine.outer_radius_m);
  const Windows windows{.load_rad = load.width_rad};
  std::vector<Asymptote<Fine>> asymptotes;
  for (const Row row : rows) asymptotes.push_back(asymptote(fine, row));
  FineMatrix table(lastReflected(annulus.core_radius_m / annulus.outer_radius_m) + 1, 2 * rows.size());
  for (int n = 0; n < table.rows(); ++n) {
    const HarmonicResponse<Fine> response = model(n);
    const Fine factor = windows.factor<Fine>(n);
    for (Eigen::Index i = 0; i < table.cols(); ++i) {
      const auto k = static_cast<std::size_t>(i / 2);
      const auto traction = static_cast<Traction>(i % 2);
      const Fine known = n < 2 ? 0 : asymptotes[k].at(n, traction);
      table(n, i) = factor * (response(rows[k], traction) - known);
    }
  }
  return table;
}

}  // namespace

Eigen::MatrixXd computeSurfaceField(const Annulus<double>& annulus, const SurfaceLoad& load,
                                    std::span<const double> angles_rad, std::span<const Row> rows) {
  requireDomain(annulus, annulus.outer_radius_m, {.load_rad = load.width_rad}, kRounding);
  const FineMatrix table = reflectedSeries(annulus, load, rows);
  const FineMatrix field =
      sumSeries(table, rows, annulus, load, angles_rad) + sumAsymptotes(annulus, load, angles_rad, rows);
  return field.cast<double>();
}

}  // namespace strainfinger::model
