#include "host/contact/contact_regions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
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
