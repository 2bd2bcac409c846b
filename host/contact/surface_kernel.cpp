#include "host/contact/surface_kernel.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "host/model/harmonic.hpp"
#include "host/model/series.hpp"

namespace strainfinger::contact {
namespace {

using std::numbers::pi;

constexpr double kRounding = std::numeric_limits<double>::epsilon() / 16;  // of a sum, per term

int lastReflected(double alpha) {
  int n = 2;
  while (n < model::kMaxHarmonics && 10.0 * n * n * std::pow(alpha, 2 * n) > kRounding) ++n;
  return n;
}

/// ln(2 sin(|psi| / 2) / |psi|): below 0.6 by its series, -zeta(2k)/k (psi / 2 pi)^2k, to rounding.
double logSinc(double angle_rad) {
  constexpr std::array kSeries{1.0 / 6,      1.0 / 180,          1.0 / 2835,      1.0 / 37800,
                               1.0 / 467775, 691 / 3831077250.0, 2 / 127702575.0, 3617 / 2605132530000.0};
  const double half = std::abs(angle_rad) / 2, square = half * half;
  if (half > 0.3) return std::log(std::sin(half) / half);
  double sum = 0;
  for (std::size_t k = kSeries.size(); k-- > 0;) sum = square * (kSeries[k] + sum);
  return -sum;
}

}  // namespace

SurfaceKernel::SurfaceKernel(const model::Annulus<double>& annulus)
    : annulus_(annulus),
      scale_(annulus.outer_radius_m / (4 * pi * annulus.shear_modulus_pa)),
      kappa_(3 - 4 * annulus.poisson_ratio) {
  using namespace model;
  const HarmonicModel<double> harmonic(annulus, annulus.outer_radius_m);
  const int count = lastReflected(annulus.core_radius_m / annulus.outer_radius_m) + 1;
  reflection_ = {Eigen::VectorXd(count), Eigen::VectorXd(count), Eigen::VectorXd(count)};
  for (int n = 0; n < count; ++n) {
    const HarmonicResponse<double> response = harmonic(n);
    const double along = n < 2 ? 0 : pi * scale_ * (kappa_ / (n + 1) + 1.0 / (n - 1));
    const double across = n < 2 ? 0 : pi * scale_ * (1.0 / (n - 1) - kappa_ / (n + 1));
    reflection_.normal[n] = response(kUr, kNormal) - along;
    reflection_.coupling[n] = response(kUr, kTangential) - across;
    reflection_.sheared[n] = response(kUt, kTangential) - along;
  }
}

KernelParts SurfaceKernel::even(double angle_rad) const {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const double log = -(kappa_ + 1) * c, saw = (kappa_ - 1) / 2 * s;
  return {scale_ * log, scale_ * saw * pi,
          scale_ * (log * logSinc(angle_rad) - saw * angle_rad - kappa_ * (1 + c / 2))};
}

KernelParts SurfaceKernel::odd(double angle_rad) const {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const double log = -(kappa_ + 1) * s, saw = (1 - kappa_) / 2 * c;
  return {scale_ * log, scale_ * saw * pi,
          scale_ * (log * logSinc(angle_rad) - saw * angle_rad + kappa_ * s / 2)};
}

KernelTable SurfaceKernel::table(double even, double odd, const Eigen::ArrayXd& at_rad,
                                 const Eigen::ArrayXd& from_rad) const {
  using Eigen::ArrayXXd, Eigen::VectorXd;
  const VectorXd cosAt = at_rad.cos(), sinAt = at_rad.sin(), cosFrom = from_rad.cos(),
                 sinFrom = from_rad.sin();
  const ArrayXXd c = (cosAt * cosFrom.transpose() + sinAt * sinFrom.transpose()).array(),
                 s = (sinAt * cosFrom.transpose() - cosAt * sinFrom.transpose()).array(),
                 angles =
                     at_rad.replicate(1, from_rad.size()) - from_rad.transpose().replicate(at_rad.size(), 1);
  KernelTable table;
  table.log = -scale_ * (kappa_ + 1) * (even * c + odd * s);
  const ArrayXXd saw = scale_ * (kappa_ - 1) / 2 * (even * s - odd * c);
  table.sgn = saw * pi;
  table.smooth = table.log * angles.unaryExpr(&logSinc) - saw * angles -
                 scale_ * kappa_ * (even * (1 + c / 2) - odd * s / 2);
  return table;
}

KernelPair SurfaceKernel::valuesAt(double angle_rad) const {
  const double s = std::sin(angle_rad), c = std::cos(angle_rad);
  const double C = -std::log(std::abs(angle_rad)) - logSinc(angle_rad);
  const double S = std::copysign((pi - std::abs(angle_rad)) / 2, angle_rad);
  return {scale_ * ((kappa_ + 1) * c * C + (kappa_ - 1) * s * S - kappa_ * (1 + c / 2)),
          scale_ * ((kappa_ + 1) * s * C - (kappa_ - 1) * c * S + kappa_ * s / 2)};
}

KernelPair SurfaceKernel::slopesAt(double angle_rad) const {
  const double s = std::sin(angle_rad), c = std::cos(angle_rad),
               halfCotangent = 0.5 / std::tan(angle_rad / 2);
  const double C = -std::log(2 * std::abs(std::sin(angle_rad / 2)));
  const double S = std::copysign((pi - std::abs(angle_rad)) / 2, angle_rad);
  return {scale_ *
              (-(kappa_ + 1) * (s * C + c * halfCotangent) + (kappa_ - 1) * (c * S - s / 2) + kappa_ * s / 2),
          scale_ *
              ((kappa_ + 1) * (c * C - s * halfCotangent) + (kappa_ - 1) * (s * S + c / 2) + kappa_ * c / 2)};
}

double SurfaceKernel::oddStep() const { return -scale_ * (kappa_ - 1) * pi; }

double SurfaceKernel::evenPole() const { return -scale_ * (kappa_ + 1); }

double SurfaceKernel::edgeShift(double friction) const {
  return std::atan(friction * (kappa_ - 1) / (kappa_ + 1)) / pi;
}

}  // namespace strainfinger::contact
