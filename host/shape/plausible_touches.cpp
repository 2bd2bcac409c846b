#include "host/shape/plausible_touches.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace strainfinger::shape {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kSpacing = 1.25;       ///< sigmas: sums over a normal distribution are good to 1e-5
constexpr double kMostOfPitch = 0.15;   ///< steps, so that where sigmas are huge no valley is stepped over
constexpr double kMostOfDepth = 0.5;    ///< of the moment of a contact as wide as the gauges are deep
constexpr double kLeast = 1e-12;        ///< variance across a valley over that along it: rounding
constexpr std::size_t kFewPlaces = 14;  ///< a straight valley has twice as many
constexpr int kMostHalvings = 5;

using Cell = std::pair<int, int>;

/// Columns: the lattice's steps in angle and moment, along the valley and across.
Matrix2d latticeOf(const TouchModel& model, const TouchFit& fit) {
  const double sigma = std::sqrt(fit.covariance(0, 0)), along = fit.covariance(0, 3) / sigma;
  const double across = std::sqrt(std::max(fit.covariance(3, 3) - along * along, kLeast * along * along));
  Matrix2d steps;
  steps << sigma, 0, along, across;
  steps *= kSpacing;
  const Eigen::Array2d most{kMostOfPitch * 2 * std::numbers::pi / model.gauges(),
                            kMostOfDepth * momentOfWidth(model.depth())};
  for (const int column : {0, 1})
    steps.col(column) *= std::min(1.0, (most / steps.col(column).array().abs()).minCoeff());
  return steps;
}

/// The loads by linear least squares.
PlausibleTouch touchAt(const TouchModel& model, const Eigen::VectorXd& strains, double noise,
                       const Vector2d& place) {
  const auto columns = model.respond(Profile::kEllipse, {place[0], 1, 1, place[1]}).slopes;
  const Eigen::MatrixX2d perLoad = columns.middleCols<2>(1);
  const Matrix2d covariance = (perLoad.transpose() * perLoad).inverse();
  const Vector2d loads = covariance * (perLoad.transpose() * strains);
  return {{place[0], loads[0], loads[1], place[1]},
          noise * noise * covariance,
          (strains - perLoad * loads).squaredNorm() / (noise * noise),
          0};
}

/// From cell to cell as far as they are plausible.
std::vector<PlausibleTouch> flood(const TouchModel& model, const Eigen::VectorXd& strains, double noise,
                                  const TouchFit& fit, const Matrix2d& steps) {
  const Vector2d origin{fit.touch.angle_rad, fit.touch.moment_rad2};
  std::vector<PlausibleTouch> touches;
  std::set<Cell> seen;
  std::vector<Cell> cells;
  const auto visit = [&](const Cell& cell) {
    if (cells.size() >= kMostPlaces || !seen.insert(cell).second) return;
    const Vector2d place = origin + steps * Vector2d(cell.first, cell.second);
    if (place[1] < model.leastMoment_rad2() || place[1] > model.kMostMoment_rad2) return;
    PlausibleTouch touch = touchAt(model, strains, noise, place);
    if (!(touch.chiSquared < fit.chiSquared + kPlausible)) return;
    touch.area = std::abs(steps.determinant());
    cells.push_back(cell);
    touches.push_back(touch);
  };
  visit({0, 0});
  for (std::size_t next = 0; next < cells.size(); ++next)
    for (const int along : {-1, 0, 1})
      for (const int across : {-1, 0, 1}) visit({cells[next].first + along, cells[next].second + across});
  return touches;
}

}  // namespace

PlausibleTouches plausibleTouches(const TouchModel& model, const Eigen::VectorXd& strains, double noise,
                                  const TouchFit& fit) {
  if (!fit.covariance.allFinite()) return {};
  Matrix2d steps = latticeOf(model, fit);
  auto touches = flood(model, strains, noise, fit, steps);
  bool areAll = touches.size() >= kFewPlaces;
  for (int turn = 0; turn < kMostHalvings && touches.size() < kFewPlaces; ++turn) {
    steps.col(0) /= 2;
    touches = flood(model, strains, noise, fit, steps);
  }
  areAll &= touches.size() < kMostPlaces;
  return {std::move(touches), areAll};
}

}  // namespace strainfinger::shape
