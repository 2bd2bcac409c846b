#pragma once
// The response of one harmonic by another route than the product's: the Michell stress functions r^n, r^-n,
// r^(n+2), r^(2-n) (for n = 0: ln r, r^2 and the rotations; for n = 1: 1/r, r^3, the single-valued combination
// of r ln r sin theta and r theta cos theta, and the translation), their stresses and displacements from
// the paper's sec. 2.3, and the four boundary conditions as a linear system, in 100 digits.

#include <Eigen/LU>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>

#include "host/model/harmonic.hpp"

namespace strainfinger::testing {

using Wide = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>,
                                           boost::multiprecision::et_off>;
using WideAnnulus = model::Annulus<Wide>;

/// A double annulus, its numbers taken as exact.
inline WideAnnulus widen(const model::Annulus<double>& annulus) {
  return {annulus.core_radius_m, annulus.outer_radius_m, annulus.shear_modulus_pa, annulus.poisson_ratio};
}

/// Stresses and 2 mu displacements of one stress function: factors of sin (trr, ttt, ur) and cos (trt, ut).
struct Mode {
  Wide trr, trt, ttt, ur, ut;
};

class MichellOracle {
 public:
  explicit MichellOracle(const WideAnnulus& annulus) : finger_(annulus) {}

  model::HarmonicResponse<Wide> respond(int n, const Wide& r) const {
    const std::array<Mode, 4> outer = modes(n, finger_.outer_radius_m), inner = modes(n, finger_.core_radius_m);
    Eigen::Matrix<Wide, 4, 4> system;
    for (int i = 0; i < 4; ++i) {
      const auto& [o, c] = std::pair{outer[static_cast<std::size_t>(i)], inner[static_cast<std::size_t>(i)]};
      system.col(i) << o.trr, o.trt, c.ur / finger_.core_radius_m, c.ut / finger_.core_radius_m;
    }
    const Eigen::Matrix<Wide, 4, 2> loads = Eigen::Matrix<Wide, 4, 2>::Identity();
    const Eigen::Matrix<Wide, 4, 2> factors = system.fullPivLu().solve(loads);
    return combine(modes(n, r), factors);
  }

 private:
  std::array<Mode, 4> modes(int n, const Wide& r) const {
    if (n == 0) return {logarithm(r), square(r), Mode{0, 1 / (r * r), 0, 0, -1 / r}, Mode{0, 0, 0, 0, r}};
    if (n == 1) return {power(1, -1, r), biharmonic(1, 1, r), line(r), Mode{0, 0, 0, 1, 1}};
    return {power(n, n, r), power(n, -n, r), biharmonic(n, n, r), biharmonic(n, -n, r)};
  }

  // phi = ln r and phi = r^2: u = -phi' + (1 - nu) 4 r for the latter.
  Mode logarithm(const Wide& r) const { return {1 / (r * r), 0, -1 / (r * r), -1 / r, 0}; }
  Mode square(const Wide& r) const { return {2, 0, 2, 2 * r * (1 - 2 * finger_.poisson_ratio), 0}; }

  // phi = r^k sin n theta with k = n or -n, harmonic; scaled to be of order one where it is largest.
  Mode power(int n, int k, const Wide& r) const {
    const Wide f = scaled(r, k);
    return withDisplacements(n, k, r, f, -k, -n);
  }

  // phi = r^(k+2) sin n theta with k = n or -n: laplacian 4 (k + 1) r^k sin n theta.
  Mode biharmonic(int n, int k, const Wide& r) const {
    const Wide f = scaled(r, k) * r * r;
    const Wide conjugate = 4 * (1 - finger_.poisson_ratio);
    return withDisplacements(n, k + 2, r, f, conjugate - (k + 2), k > 0 ? -n - conjugate : conjugate - n);
  }

  Mode withDisplacements(int n, int k, const Wide& r, const Wide& f, const Wide& ur, const Wide& ut) const {
    const Wide stress = f / (r * r);
    return {stress * (k - n * n), stress * n * (1 - k), stress * k * (k - 1), ur * f / r, ut * f / r};
  }

  // phi = (1 - 2 nu) r ln r sin theta + 2 (1 - nu) r theta cos theta, the single-valued one.
  Mode line(const Wide& r) const {
    const Wide& nu = finger_.poisson_ratio;
    const Wide c = 1 - 2 * nu, d = 2 * (1 - nu), kappa = 3 - 4 * nu;
    const Wide logarithm = log(r / finger_.outer_radius_m);
    return {(c - 2 * d) / r, -c / r, c / r, -kappa * logarithm - c, -kappa * logarithm - d};
  }

  Wide scaled(const Wide& r, int k) const {
    return pow(k > 0 ? Wide(r / finger_.outer_radius_m) : Wide(r / finger_.core_radius_m), k);
  }

  model::HarmonicResponse<Wide> combine(const std::array<Mode, 4>& modes,
                                        const Eigen::Matrix<Wide, 4, 2>& factors) const {
    using namespace model;
    const Wide twoMu = 2 * finger_.shear_modulus_pa, nu = finger_.poisson_ratio;
    HarmonicResponse<Wide> sum = HarmonicResponse<Wide>::Zero();
    for (int i = 0; i < 4; ++i) {
      const Mode& m = modes[static_cast<std::size_t>(i)];
      Eigen::Matrix<Wide, kRowCount, 1> column;
      column << m.trr, m.trt, m.ttt, m.ur / twoMu, m.ut / twoMu, ((1 - nu) * m.trr - nu * m.ttt) / twoMu,
          ((1 - nu) * m.ttt - nu * m.trr) / twoMu;
      sum += column * factors.row(i);
    }
    return sum;
  }

  WideAnnulus finger_;
};

}  // namespace strainfinger::testing
