#include "host/bench/model/precise.hpp"

#include <algorithm>

namespace strainfinger::bench {

using namespace model;

Annulus<Precise> preciseAnnulus() {
  const Annulus<double> annulus = benchAnnulus();
  return {annulus.core_radius_m, annulus.outer_radius_m, annulus.shear_modulus_pa, annulus.poisson_ratio};
}

Eigen::MatrixXd preciseField(double radius_m, const SurfaceLoad& load, std::span<const double> angles_rad) {
  constexpr int kHarmonics = 400;
  const HarmonicModel<Precise> responses(preciseAnnulus(), Precise(radius_m));
  const Precise unit = 1 / (boost::math::constants::pi<Precise>() * preciseAnnulus().outer_radius_m);
  Eigen::MatrixX<Precise> sum =
      Eigen::MatrixX<Precise>::Zero(static_cast<Eigen::Index>(angles_rad.size()), kRowCount);
  for (int n = 0; n <= kHarmonics; ++n) {
    const HarmonicResponse<Precise> response = responses(n);
    for (Eigen::Index k = 0; k < sum.rows(); ++k) {
      const Precise angle = n * Precise(angles_rad[static_cast<std::size_t>(k)]);
      const Precise c = (n == 0 ? unit / 2 : unit) * cos(angle), s = unit * sin(angle);
      for (int row = 0; row < kRowCount; ++row) {
        const bool isEven = isEvenInNormalLoad(static_cast<Row>(row));
        sum(k, row) += -load.normal_n_per_m * response(row, kNormal) * (isEven ? c : Precise(-s)) +
                       load.tangential_n_per_m * response(row, kTangential) * (isEven ? s : c);
      }
    }
  }
  return sum.cast<double>();
}

double worstError(const Eigen::MatrixXd& found, const Eigen::MatrixXd& known) {
  double worst = 0;
  for (Eigen::Index i = 0; i < known.cols(); ++i)
    worst = std::max(
        worst, (found.col(i) - known.col(i)).cwiseAbs().maxCoeff() / known.col(i).cwiseAbs().maxCoeff());
  return worst;
}

}  // namespace strainfinger::bench
