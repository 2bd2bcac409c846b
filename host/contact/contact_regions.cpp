#include "host/contact/contact_regions.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "host/base/failure.hpp"
#include "host/model/series.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kCells = 256;
constexpr int kMostSteps = 200;
constexpr int kMostZooms = 12;
constexpr int kMostLoads = 60;
constexpr double kWidthFits = 0.01;

struct Range {
  double first_rad, last_rad;
  double cell_rad() const { return (last_rad - first_rad) / kCells; }
  double middle_rad(Index cell) const { return first_rad + (static_cast<double>(cell) + 0.5) * cell_rad(); }
};

/// How deep a uniform pressure of 1 Pa on a cell presses another, by their distance in cells [m/Pa].
VectorXd cellInfluence(const SurfaceKernel& kernel, double cell_rad) {
  VectorXd influence(kCells);
  const KernelParts here = kernel.even(0);
  influence[0] = here.log * (std::log(cell_rad / 2) - 1) + here.smooth;
  for (Index i = 1; i < kCells; ++i) influence[i] = kernel.evenAt(static_cast<double>(i) * cell_rad).value;
  const VectorXd& reflected = kernel.reflection().normal;
  for (Index i = 0; i < kCells; ++i)
    model::visitMultiples(static_cast<double>(i) * cell_rad, static_cast<int>(reflected.size()) - 1,
                          [&](int n, double c, double) {
                            influence[i] += reflected[n] * c / std::numbers::pi / (n == 0 ? 2 : 1);
                          });
  return influence * cell_rad;
}

/// One grid: heights of the gap over the cells, and the cells' influence on each other.
class CellContact {
 public:
  CellContact(const SurfaceKernel& kernel, const Indenter& indenter, Range range)
      : range_(range), radius_m_(kernel.annulus().outer_radius_m), gap_m_(kCells), matrix_(kCells, kCells) {
    const VectorXd influence = cellInfluence(kernel, range.cell_rad());
    for (Index i = 0; i < kCells; ++i)
      for (Index j = 0; j < kCells; ++j) matrix_(i, j) = influence[std::abs(i - j)];
    fillGaps(indenter);
  }

  const Range& range() const { return range_; }

  /// The cells that touch under a load. Cells that pull leave, those that penetrate join.
  std::vector<Index> touching(double load_n_per_m) const {
    std::vector<Index> active;
    for (Index i = 0; i < kCells; ++i) active.push_back(i);
    for (int step = 0; step < kMostSteps; ++step) {
      const VectorXd solution = solve(active, load_n_per_m);
      const std::vector<Index> next = nextActive(active, solution);
      if (next == active) break;
      active = next;
    }
    return active;
  }

 private:
  /// The gap in the middle of each cell, by a straight line between its ends, and as much less as the
  /// measured points within come below that line: what is narrower than a cell stands out over all of it.
  void fillGaps(const Indenter& indenter) {
    VectorXd ends(kCells + 1), below = VectorXd::Zero(kCells);
    const auto gap = [&](double angle_rad) {
      return radius_m_ * angle_rad * angle_rad / 2 + indenter.height(radius_m_ * angle_rad);
    };
    for (Index i = 0; i <= kCells; ++i)
      ends[i] = gap(range_.first_rad + static_cast<double>(i) * range_.cell_rad());
    const auto lookAt = [&](double angle_rad) {
      const double cells = (angle_rad - range_.first_rad) / range_.cell_rad();
      const auto i = static_cast<Index>(cells);
      if (!(cells >= 0 && i < kCells)) return;
      const double t = cells - static_cast<double>(i);
      below[i] = std::min(below[i], gap(angle_rad) - (1 - t) * ends[i] - t * ends[i + 1]);
    };
    for (Index i = 0; i < kCells; ++i) lookAt(range_.middle_rad(i));
    for (const double position_m : indenter.positions_m()) lookAt(position_m / radius_m_);
    gap_m_ = (ends.head(kCells) + ends.tail(kCells)) / 2 + below;
  }

  /// Pressures of the active cells, then the approach.
  VectorXd solve(const std::vector<Index>& active, double load_n_per_m) const {
    const auto count = static_cast<Index>(active.size());
    MatrixXd equations(count + 1, count + 1);
    equations.topLeftCorner(count, count) = matrix_(active, active);
    equations.col(count).setConstant(-1);
    equations.row(count).setConstant(radius_m_ * range_.cell_rad());
    equations(count, count) = 0;
    VectorXd right(count + 1);
    right << -gap_m_(active), load_n_per_m;
    return equations.partialPivLu().solve(right);
  }

  std::vector<Index> nextActive(const std::vector<Index>& active, const VectorXd& solution) const {
    const auto count = static_cast<Index>(active.size());
    VectorXd pressures = VectorXd::Zero(kCells);
    for (Index k = 0; k < count; ++k) pressures[active[static_cast<std::size_t>(k)]] = solution[k];
    std::vector<Index> kept;
    for (Index i = 0; i < kCells; ++i)
      if (pressures[i] > 0) kept.push_back(i);
    if (static_cast<Index>(kept.size()) < count) return kept;
    const VectorXd overlap = VectorXd::Constant(kCells, solution[count]) - gap_m_ - matrix_ * pressures;
    std::vector<Index> next;
    for (Index i = 0; i < kCells; ++i)
      if (pressures[i] > 0 || overlap[i] > 1e-12 * std::abs(solution[count])) next.push_back(i);
    return next;
  }

  Range range_;
  double radius_m_;
  VectorXd gap_m_;
  MatrixXd matrix_;
};

std::vector<Patch> patchesOf(const Range& range, const std::vector<Index>& active) {
  std::vector<Patch> patches;
  for (std::size_t k = 0; k < active.size(); ++k) {
    const double first = range.middle_rad(active[k]) - range.cell_rad() / 2, last = first + range.cell_rad();
    if (k > 0 && active[k] == active[k - 1] + 1) {
      const double begin = patches.back().first_rad();
      patches.back() = {(begin + last) / 2, (last - begin) / 2};
    } else {
      patches.push_back({(first + last) / 2, (last - first) / 2});
    }
  }
  return patches;
}

/// Zooms until what touches fills half of the cells.
std::vector<Patch> regionsUnder(const SurfaceKernel& kernel, const Indenter& indenter, double load_n_per_m) {
  const double radius_m = kernel.annulus().outer_radius_m, most_rad = kWidestContact_rad / 2;
  Range range{std::max(-most_rad, indenter.firstPosition_m() / radius_m),
              std::min(most_rad, indenter.lastPosition_m() / radius_m)};
  std::vector<Patch> patches;
  for (int zoom = 0; zoom < kMostZooms; ++zoom) {
    const CellContact cells(kernel, indenter, range);
    const std::vector<Index> active = cells.touching(load_n_per_m);
    if (active.empty()) throw Failure(ExitCode::kFailure, "no contact found: the shape touches nowhere");
    patches = patchesOf(range, active);
    if (active.back() - active.front() > kCells / 2) break;
    const double spare_rad = 4 * range.cell_rad();
    range = {std::max(range.first_rad, patches.front().first_rad() - spare_rad),
             std::min(range.last_rad, patches.back().last_rad() + spare_rad)};
  }
  return patches;
}

double extent_rad(const std::vector<Patch>& patches) {
  return patches.back().last_rad() - patches.front().first_rad();
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
  std::vector<Patch> patches;
  for (int step = 0; step < kMostLoads && !search.isSqueezed(); ++step) {
    load = search.nextLoad(load);
    patches = regionsUnder(kernel, indenter, load);
    if (std::abs(search.add(load, extent_rad(patches))) < kWidthFits) return patches;
  }
  throw Failure(
      ExitCode::kFailure,
      fmt::format("no load makes a contact {} m wide: at {:.6g} N/m its width jumps, to or from {:.4g} m; "
                  "give --load-n-per-m",
                  radius_m * width_rad, search.low(), radius_m * extent_rad(patches)));
}

}  // namespace

std::vector<Patch> findRegions(const SurfaceKernel& kernel, const Indenter& indenter,
                               const ContactSize& size) {
  if (size.kind == ContactSize::Kind::kLoad) return regionsUnder(kernel, indenter, size.value);
  const double width_rad = size.value / kernel.annulus().outer_radius_m;
  std::vector<Patch> patches = regionsOfWidth(kernel, indenter, width_rad);
  if (patches.size() == 1) patches[0].half_rad = width_rad / 2;
  return patches;
}

}  // namespace strainfinger::contact
