#include "host/shape/resolved_pressure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/contact/decompositions.hpp"
#include "host/contact/jacobi.hpp"

namespace strainfinger::shape {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Gauss-Legendre nodes over the arc: exact for harmonics up to 120 over the 1 rad that the model allows,
/// more over less.
constexpr int kNodes = 40;

constexpr double kResolved = 3;  ///< sigmas

/// Norm over its arc of the semi-ellipse that carries a load: p0 sqrt(4 a / 3), p0 = 2 P / (pi a).
double normOfEllipse(double load_n_per_m, double half_m) {
  return 2 * load_n_per_m / (std::numbers::pi * half_m) * std::sqrt(4 * half_m / 3);
}

bool isOdd(const VectorXd& atNodes) { return atNodes.dot(atNodes.reverse()) < 0; }

}  // namespace

ResolvedPressure::ResolvedPressure(const TouchModel& model, const Touch& touch, double half_rad, double noise)
    : model_(model), touch_(touch), noise_(noise), half_rad_(half_rad) {
  const double half_m = half_rad_ * model.outerRadius_m();
  const double visible = noise / normOfEllipse(touch.normal_n_per_m, half_m);
  const contact::QuadratureRule rule = contact::gaussRule({0, 0}, kNodes);
  const VectorXd angles_rad = touch.angle_rad + half_rad_ * rule.nodes.array();
  const VectorXd roots = (half_m * rule.weights).cwiseSqrt();
  MatrixXd map = model.normalLineStrains(angles_rad) * roots.asDiagonal();
  const auto above = [](const VectorXd& values, double least) { return (values.array() > least).count(); };
  // Squares of the singular values: what is small among them is below any noise.
  const VectorXd squares = contact::symmetricEigenvalues(map * map.transpose());
  directions_ = static_cast<int>(above(squares, visible * visible));
  const VectorXd shear = model.respond(Profile::kEllipse, touch).slopes.col(2).normalized();
  map -= shear * (shear.transpose() * map);
  const contact::ThinSvd svd = contact::thinSvd(map);
  const Index count = std::max<Index>(1, above(svd.values, kResolved * visible));
  values_ = svd.values.head(count);
  readings_ = svd.left.leftCols(count);
  for (Index k = 0; k < count; ++k) oddResolved_ += isOdd(svd.right.col(k).cwiseQuotient(roots));
}

MatrixXd ResolvedPressure::directionsAt(const VectorXd& offsets_rad) const {
  const VectorXd angles_rad = touch_.angle_rad + offsets_rad.array();
  MatrixXd directions = model_.normalLineStrains(angles_rad).transpose() * readings_;
  directions *= values_.cwiseInverse().asDiagonal();
  for (Index i = 0; i < offsets_rad.size(); ++i)
    if (std::abs(offsets_rad[i]) > half_rad_) directions.row(i).setZero();
  return directions;
}

PressureEstimate ResolvedPressure::estimate(const VectorXd& strains, const VectorXd& offsets_rad) const {
  MatrixXd directions = directionsAt(offsets_rad);
  directions *= values_.cwiseInverse().asDiagonal();
  return {directions * (readings_.transpose() * strains), noise_ * directions.rowwise().norm()};
}

}  // namespace strainfinger::shape
