#include "host/contact/indenter.hpp"

#include <fmt/format.h>

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "host/base/angles.hpp"
#include "host/base/failure.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::Index;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void requireRising(const std::vector<double>& position_m) {
  if (position_m.size() < 4) throw Failure(ExitCode::kUsage, "a measured shape needs four points or more");
  for (std::size_t i = 1; i < position_m.size(); ++i)
    if (!(position_m[i] > position_m[i - 1]))
      throw Failure(ExitCode::kUsage,
                    fmt::format("a measured shape's positions must rise: {} m comes after {} m",
                                position_m[i], position_m[i - 1]));
}

/// Slopes at the points that make the cubic pieces twice differentiable, and the first two and last two
/// pieces one cubic each.
std::vector<double> splineSlopes(const Eigen::ArrayXd& x, const Eigen::ArrayXd& y) {
  const Index n = x.size(), last = n - 1;
  const Eigen::ArrayXd step = x.tail(last) - x.head(last), chord = (y.tail(last) - y.head(last)) / step;
  Eigen::SparseMatrix<double> matrix(n, n);
  Eigen::VectorXd right(n);
  const auto endRow = [&](Index row, Index next, Index i, Index k) {
    const double a = step[i], b = step[k];
    matrix.insert(row, row) = b;
    matrix.insert(row, next) = a + b;
    right[row] = ((3 * a + 2 * b) * b * chord[i] + a * a * chord[k]) / (a + b);
  };
  endRow(0, 1, 0, 1);
  endRow(last, last - 1, last - 1, last - 2);
  for (Index i = 1; i < last; ++i) {
    matrix.insert(i, i - 1) = step[i];
    matrix.insert(i, i) = 2 * (step[i - 1] + step[i]);
    matrix.insert(i, i + 1) = step[i - 1];
    right[i] = 3 * (step[i] * chord[i - 1] + step[i - 1] * chord[i]);
  }
  matrix.makeCompressed();
  const Eigen::VectorXd slopes = Eigen::SparseLU<Eigen::SparseMatrix<double>>(matrix).solve(right);
  return {slopes.begin(), slopes.end()};
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
  std::vector<double> slopes = splineSlopes(arrayOf(position_m), arrayOf(height_m));
  Indenter indenter(0, 0);
  indenter.spline_ =
      std::make_shared<const Spline>(Spline{std::move(position_m), std::move(height_m), std::move(slopes)});
  return indenter;
}

double Indenter::firstPosition_m() const { return spline_ ? spline_->position_m.front() : -kInfinity; }

double Indenter::lastPosition_m() const { return spline_ ? spline_->position_m.back() : kInfinity; }

std::size_t Indenter::interval(double x_m) const {
  const auto& x = spline_->position_m;
  const auto after = std::upper_bound(x.begin() + 1, x.end() - 1, x_m);
  return static_cast<std::size_t>(after - x.begin()) - 1;
}

double Indenter::height(double x_m) const {
  if (!spline_) return curvature_per_m_ * x_m * x_m / 2 + edgeSlope_ * std::abs(x_m);
  const auto& [x, y, slope] = *spline_;
  const std::size_t i = interval(x_m);
  const double step = x[i + 1] - x[i], t = (x_m - x[i]) / step, rise = y[i + 1] - y[i];
  const double before = step * slope[i] - rise, after = rise - step * slope[i + 1];
  return y[i] + t * rise + t * (1 - t) * ((1 - t) * before + t * after);
}

double Indenter::slope(double x_m) const {
  if (!spline_) return curvature_per_m_ * x_m + (x_m == 0 ? 0 : std::copysign(edgeSlope_, x_m));
  const auto& [x, y, slope] = *spline_;
  const std::size_t i = interval(x_m);
  const double step = x[i + 1] - x[i], t = (x_m - x[i]) / step, rise = y[i + 1] - y[i];
  const double before = step * slope[i] - rise, after = rise - step * slope[i + 1];
  return (rise + (1 - t) * (1 - 3 * t) * before + t * (2 - 3 * t) * after) / step;
}

}  // namespace strainfinger::contact
