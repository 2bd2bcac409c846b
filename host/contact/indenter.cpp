#include "host/contact/indenter.hpp"

#include <fmt/format.h>

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/Splines>
#include <utility>

#include "host/base/angles.hpp"
#include "host/base/failure.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::Index;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// [points] Beyond a contact's edges: there a jump's swings, 0.43 of each other, have fallen to a twelfth.
constexpr Index kSwingsReach = 3;

using FourPoints = Eigen::Array4d;

/// Of the cubic through points (Lagrange).
double cubicAt(const FourPoints& x, const FourPoints& y, double at) {
  double sum = 0;
  for (Index i = 0; i < 4; ++i) {
    double term = y[i];
    for (Index k = 0; k < 4; ++k)
      if (k != i) term *= (at - x[k]) / (x[i] - x[k]);
    sum += term;
  }
  return sum;
}

void requireRising(const std::vector<double>& position_m) {
  if (position_m.size() < 4) throw Failure(ExitCode::kUsage, "a measured shape needs four points or more");
  for (std::size_t i = 1; i < position_m.size(); ++i)
    if (!(position_m[i] > position_m[i - 1]))
      throw Failure(ExitCode::kUsage,
                    fmt::format("a measured shape's positions must rise: {} m comes after {} m",
                                position_m[i], position_m[i - 1]));
}

using Pieces = Eigen::Matrix<double, Indenter::kPowers, Eigen::Dynamic>;
using Splines = Eigen::Spline<double, 1, Eigen::Dynamic>;

/// The spline through points, of degree 5 or as much less as there are fewer than six of them: what it is
/// from each point to the next, as coefficients of powers of 0..1. Its fifth derivative jumps at the points,
/// but for the first and last three.
Pieces splineThrough(const Eigen::ArrayXd& x, const Eigen::VectorXd& y) {
  const Index count = x.size(), degree = std::min<Index>(Indenter::kPowers - 1, count - 1);
  Splines::KnotVectorType knots(count + degree + 1);
  knots << Splines::KnotVectorType::Constant(degree + 1, x[0]),
      x.segment((degree + 1) / 2, count - degree - 1).transpose(),
      Splines::KnotVectorType::Constant(degree + 1, x[count - 1]);
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.reserve(Eigen::VectorXi::Constant(count, Indenter::kPowers));
  for (Index i = 0; i < count; ++i) {
    const auto basis = Splines::BasisFunctions(x[i], degree, knots);
    for (Index k = 0, first = Splines::Span(x[i], degree, knots) - degree; k <= degree; ++k)
      if (basis[k] != 0) matrix.insert(i, first + k) = basis[k];
  }
  matrix.makeCompressed();
  const Eigen::VectorXd controls = Eigen::SparseLU<Eigen::SparseMatrix<double>>(matrix).solve(y);
  Pieces pieces = Pieces::Zero(Indenter::kPowers, count - 1);
  for (Index i = 0; i + 1 < count; ++i) {
    const auto basis = Splines::BasisFunctionDerivatives(x[i], degree, degree, knots);
    const auto near = controls.segment(Splines::Span(x[i], degree, knots) - degree, degree + 1);
    double factor = 1;
    for (Index k = 0; k <= degree; factor *= (x[i + 1] - x[i]) / static_cast<double>(++k))
      pieces(k, i) = factor * basis.row(k).matrix().dot(near);
  }
  return pieces;
}

Eigen::ArrayXd arrayOf(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::ArrayXd>(values.data(), static_cast<Index>(values.size()));
}

}  // namespace

Indenter Indenter::flat() { return {0, 0}; }

Indenter Indenter::cylinder(double radius_m) { return {1 / radius_m, 0}; }

Indenter Indenter::wedge(double half_angle_deg) { return {0, 1 / std::tan(half_angle_deg * kRadPerDeg)}; }

Indenter Indenter::measured(std::vector<double> position_m, std::vector<double> height_m) {
  requireRising(position_m);
  Indenter indenter(0, 0);
  Pieces pieces = splineThrough(arrayOf(position_m), arrayOf(height_m));
  indenter.spline_ = std::make_shared<const Spline>(Spline{std::move(position_m), std::move(pieces)});
  return indenter;
}

double Indenter::firstPosition_m() const { return spline_ ? spline_->position_m.front() : -kInfinity; }

double Indenter::lastPosition_m() const { return spline_ ? spline_->position_m.back() : kInfinity; }

Indenter::Place Indenter::place(double x_m) const {
  const auto& x = spline_->position_m;
  const auto after = std::upper_bound(x.begin() + 1, x.end() - 1, x_m), before = after - 1;
  return {before - x.begin(), (x_m - *before) / (*after - *before)};
}

Indenter::Swing Indenter::swing(double first_m, double last_m) const {
  Swing most;
  if (!spline_) return most;
  const Eigen::ArrayXd x = arrayOf(spline_->position_m);
  const Index end = std::min<Index>(place(last_m).piece + kSwingsReach + 1, x.size() - 1);
  for (Index i = std::max<Index>(0, place(first_m).piece - kSwingsReach); i < end; ++i) {
    const FourPoints near = x.segment<4>(std::clamp<Index>(i - 1, 0, x.size() - 4));
    const double middle_m = (x[i] + x[i + 1]) / 2;
    const FourPoints heights = near.unaryExpr([this](double x_m) { return height(x_m); });
    const double swing_m = std::abs(height(middle_m) - cubicAt(near, heights, middle_m));
    if (swing_m > most.height_m) most = {swing_m, middle_m};
  }
  return most;
}

double Indenter::height(double x_m) const {
  if (!spline_) return curvature_per_m_ * x_m * x_m / 2 + edgeSlope_ * std::abs(x_m);
  const auto [i, t] = place(x_m);
  double sum = 0;
  for (Index k = kPowers; k-- > 0;) sum = sum * t + spline_->pieces(k, i);
  return sum;
}

double Indenter::slope(double x_m) const {
  if (!spline_) return curvature_per_m_ * x_m + (x_m == 0 ? 0 : std::copysign(edgeSlope_, x_m));
  const auto [i, t] = place(x_m);
  double sum = 0;
  for (Index k = kPowers; k-- > 1;) sum = sum * t + static_cast<double>(k) * spline_->pieces(k, i);
  return sum / (spline_->position_m[static_cast<std::size_t>(i) + 1] -
                spline_->position_m[static_cast<std::size_t>(i)]);
}

}  // namespace strainfinger::contact
