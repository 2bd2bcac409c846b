#include "host/contact/contact_regions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "host/base/failure.hpp"
#include "host/contact/cell_contact.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kCells = 128;  // of a grid that nothing has made finer
constexpr Index kMostCells = 900;
constexpr int kMostZooms = 12;
constexpr int kMostRefinements = 6;
constexpr int kParts = 4;  // that a cell is cut into
constexpr int kMostLoads = 60;
constexpr double kWidthFits = 0.01;

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
    touch.grid = {VectorXd::LinSpaced(kCells + 1, first_rad, last_rad)};
    const CellContact cells(kernel, indenter, touch.grid);
    touch.active = cells.touching(load_n_per_m, cells.all());
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

/// A measured shape above the undeformed surface, and the region below some level of it.
class Basin {
 public:
  Basin(double radius_m, const Indenter& indenter) : x_m_(indenter.positions_m()) {
    for (const double x_m : x_m_) gap_m_.push_back(x_m * x_m / (2 * radius_m) + indenter.height(x_m));
    lowest_ = static_cast<std::size_t>(std::ranges::min_element(gap_m_) - gap_m_.begin());
  }

  double lowestAt_m() const { return x_m_[lowest_]; }
  bool isLowestAtAnEnd() const { return lowest_ == 0 || lowest_ + 1 == x_m_.size(); }
  double lowest_m() const { return gap_m_[lowest_]; }
  double highest_m() const { return std::ranges::max(gap_m_); }

  struct Region {
    double first_m, last_m;
    double area_m2;  ///< between level and gap

    double width_m() const { return last_m - first_m; }
  };
  Region below(double level_m) const {
    Region region{x_m_[lowest_], x_m_[lowest_], 0};
    for (std::size_t i = lowest_; i > 0 && region.first_m == x_m_[i]; --i)
      region.first_m = step(i, i - 1, level_m, region.area_m2);
    for (std::size_t i = lowest_; i + 1 < x_m_.size() && region.last_m == x_m_[i]; ++i)
      region.last_m = step(i, i + 1, level_m, region.area_m2);
    return region;
  }

 private:
  /// Where the region ends between two points, straight from one to the other.
  double step(std::size_t from, std::size_t to, double level_m, double& area_m2) const {
    const double depth_m = level_m - gap_m_[from], next_m = std::max(0.0, level_m - gap_m_[to]);
    const double share = next_m > 0 ? 1 : depth_m / (gap_m_[to] - gap_m_[from]);
    const double length_m = share * (x_m_[to] - x_m_[from]);
    area_m2 += std::abs(length_m) * (depth_m + next_m) / 2;
    return next_m > 0 ? x_m_[to] : x_m_[from] + length_m;
  }

  std::vector<double> x_m_, gap_m_;
  std::size_t lowest_;
};

/// What is lowest touches first, and wider than that place.
void requireLowestWithin(const Basin& basin) {
  if (basin.isLowestAtAnEnd())
    throw Failure(
        ExitCode::kFailure,
        fmt::format("no contact found: the measured shape is nearest to the finger at its end, {:.6g} "
                    "m, and touches beyond it: measure more of it",
                    basin.lowestAt_m()));
}

}  // namespace

Patch guessRegion(const SurfaceKernel& kernel, const Indenter& indenter, const ContactSize& size) {
  constexpr int kHalvings = 30;
  const model::Annulus<double>& annulus = kernel.annulus();
  const double modulus_pa = 2 * annulus.shear_modulus_pa / (1 - annulus.poisson_ratio);
  const Basin basin(annulus.outer_radius_m, indenter);
  // a parabola's load is (pi/2) E* depth, the area above it (2/3) depth width
  const auto sizeOf = [&](const Basin::Region& region) {
    return size.kind == ContactSize::Kind::kWidth
               ? region.width_m()
               : 3 * std::numbers::pi / 4 * modulus_pa * region.area_m2 / region.width_m();
  };
  double low_m = basin.lowest_m(), high_m = basin.highest_m();
  for (int step = 0; step < kHalvings; ++step) {
    const double level_m = (low_m + high_m) / 2;
    (sizeOf(basin.below(level_m)) < size.value ? low_m : high_m) = level_m;
  }
  const Basin::Region region = basin.below(high_m);
  const double scale = 1 / annulus.outer_radius_m;
  return {scale * (region.first_m + region.last_m) / 2, scale * region.width_m() / 2};
}

std::vector<Patch> findRegions(const SurfaceKernel& kernel, const Indenter& indenter,
                               const ContactSize& size) {
  requireLowestWithin(Basin(kernel.annulus().outer_radius_m, indenter));
  if (size.kind == ContactSize::Kind::kLoad)
    return refinedRegions(kernel, indenter, size.value, touchUnder(kernel, indenter, size.value));
  const double width_rad = size.value / kernel.annulus().outer_radius_m;
  std::vector<Patch> patches = regionsOfWidth(kernel, indenter, width_rad);
  if (patches.size() == 1) patches[0].half_rad = width_rad / 2;
  return patches;
}

}  // namespace strainfinger::contact
