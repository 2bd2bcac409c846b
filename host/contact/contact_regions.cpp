#include "host/contact/contact_regions.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "host/base/failure.hpp"
#include "host/model/series.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kCells = 128;  // of a grid that nothing has made finer
constexpr Index kMostCells = 900;
constexpr int kMostSteps = 200;
constexpr int kMostZooms = 12;
constexpr int kMostRefinements = 6;
constexpr int kParts = 4;  // that a cell is cut into
constexpr int kMostLoads = 60;
constexpr double kWidthFits = 0.01;

/// Uniform cells, or some that were cut.
struct Grid {
  VectorXd edges_rad;  ///< one more than cells

  static Grid uniform(double first_rad, double last_rad) {
    return {VectorXd::LinSpaced(kCells + 1, first_rad, last_rad)};
  }
  Index cells() const { return edges_rad.size() - 1; }
  VectorXd middles_rad() const { return (edges_rad.head(cells()) + edges_rad.tail(cells())) / 2; }
  VectorXd widths_rad() const { return edges_rad.tail(cells()) - edges_rad.head(cells()); }
};

/// cos n x and sin n x: one row a place.
MatrixXd multiples(const VectorXd& angles_rad, Index harmonics) {
  MatrixXd result(angles_rad.size(), 2 * harmonics);
  for (Index i = 0; i < angles_rad.size(); ++i)
    model::visitMultiples(angles_rad[i], static_cast<int>(harmonics) - 1, [&](int n, double c, double s) {
      result(i, n) = c;
      result(i, harmonics + n) = s;
    });
  return result;
}

/// How deep a uniform pressure of 1 Pa on each cell (column) presses the middle of each (row) [m/Pa]: the
/// logarithm integrated over the cell, the rest of the kernel by its middle.
MatrixXd cellInfluence(const SurfaceKernel& kernel, const Grid& grid) {
  const auto antiderivative = [](double x) { return x == 0 ? 0 : x * std::log(std::abs(x)) - x; };
  const VectorXd middles = grid.middles_rad(), widths = grid.widths_rad();
  VectorXd reflected = kernel.reflection().normal / std::numbers::pi;
  reflected[0] /= 2;
  const MatrixXd waves = multiples(middles, reflected.size());
  MatrixXd influence = waves * reflected.replicate(2, 1).asDiagonal() * waves.transpose();
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

/// One grid: heights of the gap over the cells, and the cells' influence on each other.
class CellContact {
 public:
  CellContact(const SurfaceKernel& kernel, const Indenter& indenter, const Grid& grid)
      : grid_(grid), radius_m_(kernel.annulus().outer_radius_m), matrix_(cellInfluence(kernel, grid)) {
    fillGaps(indenter);
  }

  /// The cells that touch under a load, from those that may. Cells that pull leave, those that penetrate
  /// join.
  std::vector<Index> touching(double load_n_per_m, std::vector<Index> active) const {
    for (int step = 0; step < kMostSteps; ++step) {
      const VectorXd solution = solve(active, load_n_per_m);
      const std::vector<Index> next = nextActive(active, solution);
      if (next == active) break;
      active = next;
    }
    return active;
  }

  std::vector<Index> all() const {
    std::vector<Index> cells(static_cast<std::size_t>(grid_.cells()));
    std::iota(cells.begin(), cells.end(), Index{0});
    return cells;
  }

  /// How far the shape comes below the straight line between a cell's ends, or above it; 0 if the cell is as
  /// narrow as measured points are apart.
  double roughness_m(Index cell) const {
    return points_[cell] > 1 ? std::max(below_m_[cell], above_m_[cell]) : 0;
  }

 private:
  /// The gap in the middle of each cell, by a straight line between its ends, and as much less as the
  /// measured points within come below that line: what is narrower than a cell stands out over all of it.
  void fillGaps(const Indenter& indenter) {
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

  /// Pressures of the active cells, then the approach.
  VectorXd solve(const std::vector<Index>& active, double load_n_per_m) const {
    const auto count = static_cast<Index>(active.size());
    const VectorXd widths = grid_.widths_rad();
    MatrixXd equations(count + 1, count + 1);
    equations.topLeftCorner(count, count) = matrix_(active, active);
    equations.col(count).setConstant(-1);
    equations.row(count).head(count) = radius_m_ * widths(active);
    equations(count, count) = 0;
    VectorXd right(count + 1);
    right << -gap_m_(active), load_n_per_m;
    return equations.partialPivLu().solve(right);
  }

  std::vector<Index> nextActive(const std::vector<Index>& active, const VectorXd& solution) const {
    const auto count = static_cast<Index>(active.size());
    VectorXd pressures = VectorXd::Zero(grid_.cells());
    for (Index k = 0; k < count; ++k) pressures[active[static_cast<std::size_t>(k)]] = solution[k];
    std::vector<Index> kept;
    for (const Index i : active)
      if (pressures[i] > 0) kept.push_back(i);
    if (static_cast<Index>(kept.size()) < count) return kept;
    const VectorXd overlap =
        VectorXd::Constant(grid_.cells(), solution[count]) - gap_m_ - matrix_ * pressures;
    std::vector<Index> next;
    for (Index i = 0; i < grid_.cells(); ++i)
      if (pressures[i] > 0 || overlap[i] > 1e-12 * std::abs(solution[count])) next.push_back(i);
    return next;
  }

  const Grid& grid_;
  double radius_m_;
  MatrixXd matrix_;
  VectorXd gap_m_, below_m_, above_m_, points_;
};

std::vector<Patch> patchesOf(const Grid& grid, const std::vector<Index>& active) {
  std::vector<Patch> patches;
  for (std::size_t k = 0; k < active.size(); ++k) {
    double first = grid.edges_rad[active[k]];
    const double last = grid.edges_rad[active[k] + 1];
    if (k > 0 && active[k] == active[k - 1] + 1) {
      first = patches.back().first_rad();
      patches.pop_back();
    }
    patches.push_back({(first + last) / 2, (last - first) / 2});
  }
  return patches;
}

struct Touch {
  Grid grid;
  std::vector<Index> active;

  double extent_rad() const { return grid.edges_rad[active.back() + 1] - grid.edges_rad[active.front()]; }
};

/// Zooms until what touches fills half of the cells.
Touch touchUnder(const SurfaceKernel& kernel, const Indenter& indenter, double load_n_per_m) {
  const double radius_m = kernel.annulus().outer_radius_m, most_rad = kWidestContact_rad / 2;
  double first_rad = std::max(-most_rad, indenter.firstPosition_m() / radius_m),
         last_rad = std::min(most_rad, indenter.lastPosition_m() / radius_m);
  Touch touch;
  for (int zoom = 0; zoom < kMostZooms; ++zoom) {
    touch.grid = Grid::uniform(first_rad, last_rad);
    const CellContact cells(kernel, indenter, touch.grid);
    touch.active = cells.touching(load_n_per_m, cells.all());
    if (touch.active.empty())
      throw Failure(ExitCode::kFailure, "no contact found: the shape touches nowhere");
    if (touch.active.back() - touch.active.front() > kCells / 2) break;
    const double spare_rad = 4 * (last_rad - first_rad) / kCells;
    const double low_rad = touch.grid.edges_rad[touch.active.front()],
                 high_rad = touch.grid.edges_rad[touch.active.back() + 1];
    first_rad = std::max(first_rad, low_rad - spare_rad);
    last_rad = std::min(last_rad, high_rad + spare_rad);
  }
  return touch;
}

/// The same with the cells cut that touch, or are beside such, and are too rough; and what may touch of it.
Touch refined(const Touch& touch, const CellContact& cells, double rough_per_rad) {
  const Index count = touch.grid.cells();
  const VectorXd widths = touch.grid.widths_rad();
  Eigen::VectorX<bool> touches = Eigen::VectorX<bool>::Constant(count + 2, false);
  for (const Index i : touch.active) touches[i + 1] = true;
  std::vector<double> edges{touch.grid.edges_rad[0]};
  Touch finer;
  for (Index i = 0; i < count; ++i) {
    const bool isNear = touches[i] || touches[i + 1] || touches[i + 2];
    const int parts = isNear && cells.roughness_m(i) > rough_per_rad * widths[i] ? kParts : 1;
    for (int part = 1; part <= parts; ++part) {
      if (touches[i + 1] || parts > 1) finer.active.push_back(static_cast<Index>(edges.size()) - 1);
      edges.push_back(touch.grid.edges_rad[i] + widths[i] * part / parts);
    }
  }
  finer.grid.edges_rad = Eigen::Map<VectorXd>(edges.data(), static_cast<Index>(edges.size()));
  return finer;
}

/// Cuts cells until the shape is nearly straight on each, measured by what it rises over the contact.
std::vector<Patch> refinedRegions(const SurfaceKernel& kernel, const Indenter& indenter, double load_n_per_m,
                                  Touch touch) {
  constexpr double kRough = 0.1;
  const double radius_m = kernel.annulus().outer_radius_m;
  for (int step = 0; step < kMostRefinements; ++step) {
    const CellContact cells(kernel, indenter, touch.grid);
    if (step > 0) touch.active = cells.touching(load_n_per_m, touch.active);
    Touch finer = refined(touch, cells, kRough * radius_m * touch.extent_rad() / 2);
    if (finer.grid.cells() == touch.grid.cells()) break;
    if (finer.grid.cells() > kMostCells)
      throw Failure(
          ExitCode::kFailure,
          fmt::format("the measured shape is too rough between {:.4g} and {:.4g} m: {} cells don't resolve "
                      "where it touches; if that is noise of the measurement, smooth the profile",
                      radius_m * touch.grid.edges_rad[touch.active.front()],
                      radius_m * touch.grid.edges_rad[touch.active.back() + 1], kMostCells));
    touch = std::move(finer);
  }
  return patchesOf(touch.grid, touch.active);
}

/// Loads that make a narrower and a wider contact than is asked for. Widths grow with loads, about as their
/// roots: the next load is where a straight line of the logarithms has the width, or halfway at the least.
class WidthSearch {
 public:
  explicit WidthSearch(double width_rad) : width_rad_(width_rad) {}

  double nextLoad(double guess) const {
    if (low_ > 0 && std::isfinite(high_)) {
      const double t = lowMisfit_ / (lowMisfit_ - highMisfit_);
      return low_ * std::pow(high_ / low_, std::clamp(t, kLeast, 1 - kLeast));
    }
    if (low_ > 0) return low_ * std::clamp(std::exp(-2.5 * lowMisfit_), 1.1, 1e4);
    return std::isfinite(high_) ? high_ * std::clamp(std::exp(-2.5 * highMisfit_), 1e-4, 0.9) : guess;
  }

  /// The logarithm of extent over width.
  double add(double load, double extent_rad) {
    const double misfit = std::log(extent_rad / width_rad_);
    (misfit < 0 ? low_ : high_) = load;
    (misfit < 0 ? lowMisfit_ : highMisfit_) = misfit;
    return misfit;
  }

  bool isSqueezed() const { return high_ / low_ < 1 + 1e-6; }
  double low() const { return low_; }

 private:
  static constexpr double kLeast = 0.15;  // of the way, so that both ends move
  double width_rad_;
  double low_ = 0, high_ = std::numeric_limits<double>::infinity();
  double lowMisfit_ = 0, highMisfit_ = 0;
};

std::vector<Patch> regionsOfWidth(const SurfaceKernel& kernel, const Indenter& indenter, double width_rad) {
  const double radius_m = kernel.annulus().outer_radius_m;
  const double length_m = indenter.lastPosition_m() - indenter.firstPosition_m();
  if (radius_m * width_rad > length_m)
    throw Failure(ExitCode::kFailure,
                  fmt::format("the measured shape is only {:.6g} m long: measure more of it, or ask for less",
                              length_m));
  WidthSearch search(width_rad);
  double load = kernel.annulus().shear_modulus_pa * radius_m * width_rad * width_rad;
  Touch touch;
  for (int step = 0; step < kMostLoads && !search.isSqueezed(); ++step) {
    load = search.nextLoad(load);
    touch = touchUnder(kernel, indenter, load);
    if (std::abs(search.add(load, touch.extent_rad())) < kWidthFits)
      return refinedRegions(kernel, indenter, load, touch);
  }
  throw Failure(
      ExitCode::kFailure,
      fmt::format("no load makes a contact {} m wide: at {:.6g} N/m its width jumps, to or from {:.4g} m; "
                  "give --load-n-per-m",
                  radius_m * width_rad, search.low(), radius_m * touch.extent_rad()));
}

}  // namespace

std::vector<Patch> findRegions(const SurfaceKernel& kernel, const Indenter& indenter,
                               const ContactSize& size) {
  if (size.kind == ContactSize::Kind::kLoad)
    return refinedRegions(kernel, indenter, size.value, touchUnder(kernel, indenter, size.value));
  const double width_rad = size.value / kernel.annulus().outer_radius_m;
  std::vector<Patch> patches = regionsOfWidth(kernel, indenter, width_rad);
  if (patches.size() == 1) patches[0].half_rad = width_rad / 2;
  return patches;
}

}  // namespace strainfinger::contact
