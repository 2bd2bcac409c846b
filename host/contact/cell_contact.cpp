#include "host/contact/cell_contact.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "host/base/failure.hpp"
#include "host/contact/decompositions.hpp"
#include "host/contact/multiples.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostSweeps = 200;

/// How deep a uniform pressure of 1 Pa on each cell (column) presses the middle of each (row) [m/Pa]: the
/// logarithm integrated over the cell, the rest of the kernel by its middle.
MatrixXd cellInfluence(const SurfaceKernel& kernel, const Grid& grid) {
  const auto antiderivative = [](double x) { return x == 0 ? 0 : x * std::log(std::abs(x)) - x; };
  const VectorXd middles = grid.middles_rad(), widths = grid.widths_rad();
  VectorXd reflected = kernel.reflection().normal / std::numbers::pi;
  reflected[0] /= 2;
  const Multiples waves(middles, reflected.size());
  MatrixXd influence = waves.cosines * reflected.asDiagonal() * waves.cosines.transpose();
  influence += waves.sines * reflected.asDiagonal() * waves.sines.transpose();
  for (Index j = 0; j < grid.cells(); ++j)
    for (Index i = 0; i < grid.cells(); ++i) {
      const double distance = middles[i] - middles[j];
      const KernelParts parts = kernel.even(distance);
      const double logarithm =
          antiderivative(distance + widths[j] / 2) - antiderivative(distance - widths[j] / 2);
      const double sign = distance == 0 ? 0 : std::copysign(parts.sgn, distance);
      influence(i, j) = parts.log * logarithm + widths[j] * (influence(i, j) + parts.smooth + sign);
    }
  return influence;
}

}  // namespace

CellContact::CellContact(const SurfaceKernel& kernel, const Indenter& indenter, const Grid& grid)
    : grid_(grid), radius_m_(kernel.annulus().outer_radius_m), matrix_(cellInfluence(kernel, grid)) {
  fillGaps(indenter);
}

std::vector<Index> CellContact::touching(double load_n_per_m, std::vector<Index> active) const {
  for (int step = 0; step < kMostSweeps; ++step) {
    const VectorXd solution = solve(active, load_n_per_m);
    const std::vector<Index> next = nextActive(active, solution);
    if (next == active) break;
    active = next;
  }
  if (active.empty()) throw Failure(ExitCode::kFailure, "no contact found: the shape touches nowhere");
  return active;
}

std::vector<Index> CellContact::all() const {
  std::vector<Index> cells(static_cast<std::size_t>(grid_.cells()));
  std::iota(cells.begin(), cells.end(), Index{0});
  return cells;
}

double CellContact::roughness_m(Index cell) const {
  return points_[cell] > 1 ? std::max(below_m_[cell], above_m_[cell]) : 0;
}

// The gap in the middle of each cell, by a straight line between its ends, and as much less as the
// measured points within come below that line: what is narrower than a cell stands out over all of it.
void CellContact::fillGaps(const Indenter& indenter) {
  const Index count = grid_.cells();
  const auto gap = [&](double angle_rad) {
    return radius_m_ * angle_rad * angle_rad / 2 + indenter.height(radius_m_ * angle_rad);
  };
  const VectorXd ends = grid_.edges_rad.unaryExpr(gap);
  below_m_ = above_m_ = points_ = VectorXd::Zero(count);
  const auto lookAt = [&](double angle_rad, Index i) {
    const double first_rad = grid_.edges_rad[i],
                 t = (angle_rad - first_rad) / (grid_.edges_rad[i + 1] - first_rad);
    const double above_m = gap(angle_rad) - (1 - t) * ends[i] - t * ends[i + 1];
    below_m_[i] = std::max(below_m_[i], -above_m);
    above_m_[i] = std::max(above_m_[i], above_m);
  };
  for (Index i = 0; i < count; ++i) lookAt((grid_.edges_rad[i] + grid_.edges_rad[i + 1]) / 2, i);
  Index i = 0;
  for (const double position_m : indenter.positions_m()) {
    const double angle_rad = position_m / radius_m_;
    while (i < count && grid_.edges_rad[i + 1] < angle_rad) ++i;
    if (i == count || angle_rad < grid_.edges_rad[i]) continue;
    lookAt(angle_rad, i);
    ++points_[i];
  }
  gap_m_ = (ends.head(count) + ends.tail(count)) / 2 - below_m_;
}

// Pressures of the active cells, then the approach.
VectorXd CellContact::solve(const std::vector<Index>& active, double load_n_per_m) const {
  const auto count = static_cast<Index>(active.size());
  const VectorXd widths = grid_.widths_rad();
  MatrixXd equations(count + 1, count + 1);
  equations.topLeftCorner(count, count) = matrix_(active, active);
  equations.col(count).setConstant(-1);
  equations.row(count).head(count) = radius_m_ * widths(active);
  equations(count, count) = 0;
  VectorXd right(count + 1);
  right << -gap_m_(active), load_n_per_m;
  return luSolution(equations, right);
}

std::vector<Index> CellContact::nextActive(const std::vector<Index>& active, const VectorXd& solution) const {
  const auto count = static_cast<Index>(active.size());
  VectorXd pressures = VectorXd::Zero(grid_.cells());
  for (Index k = 0; k < count; ++k) pressures[active[static_cast<std::size_t>(k)]] = solution[k];
  std::vector<Index> kept;
  for (const Index i : active)
    if (pressures[i] > 0) kept.push_back(i);
  if (static_cast<Index>(kept.size()) < count) return kept;
  const VectorXd overlap = VectorXd::Constant(grid_.cells(), solution[count]) - gap_m_ - matrix_ * pressures;
  std::vector<Index> next;
  for (Index i = 0; i < grid_.cells(); ++i)
    if (pressures[i] > 0 || overlap[i] > 1e-12 * std::abs(solution[count])) next.push_back(i);
  return next;
}

}  // namespace strainfinger::contact
