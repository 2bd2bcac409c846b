#include "host/contact/overlap.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "host/contact/surface_motion.hpp"

namespace strainfinger::contact {
namespace {

constexpr int kBetween = 4;  // steps from one measured point to the next

class Gaps {
 public:
  Gaps(const SurfaceKernel& kernel, const Indenter& indenter, const Tractions& tractions, double approach_m)
      : indenter_(indenter),
        tractions_(tractions),
        approach_m_(approach_m),
        radius_m_(kernel.annulus().outer_radius_m),
        motion_(kernel, tractions),
        bulge_m_(highestSurface() + kMargin * std::abs(approach_m)) {}

  /// Negative: inside the rubber. What is above all of the surface is infinitely high.
  double at(double angle_rad) const {
    const double x_m = radius_m_ * angle_rad;
    const double above_m = x_m * angle_rad / 2 + indenter_.height(x_m) - approach_m_;
    return above_m > bulge_m_ ? std::numeric_limits<double>::infinity()
                              : above_m - motion_.displacementAt(angle_rad).ur_m;
  }

  /// Places to look at beside and between the patches: from one edge to the next, rising.
  std::vector<std::vector<double>> stretches() const {
    constexpr double kEnd_rad = std::numbers::pi / 2;
    std::vector<std::vector<double>> stretches;
    double first_rad = -kEnd_rad;
    for (const PatchTractions& part : tractions_) {
      stretches.push_back(placesBetween(first_rad, part.patch.first_rad()));
      first_rad = part.patch.last_rad();
    }
    stretches.push_back(placesBetween(first_rad, kEnd_rad));
    return stretches;
  }

  /// Gaps below this may hide a touch between two places.
  double near_m() const { return 0.01 * std::abs(approach_m_); }

 private:
  static constexpr double kMargin = 0.1;

  std::vector<double> placesBetween(double first_rad, double last_rad) const {
    const std::vector<double> positions_m = indenter_.positions_m();
    std::vector<double> places{std::max(first_rad, positions_m.front() / radius_m_)};
    for (std::size_t i = 0; i + 1 < positions_m.size(); ++i)
      for (int step = 0; step < kBetween; ++step) {
        const double angle_rad =
            (positions_m[i] + (positions_m[i + 1] - positions_m[i]) * step / kBetween) / radius_m_;
        if (angle_rad > places.front() && angle_rad < last_rad) places.push_back(angle_rad);
      }
    places.push_back(std::min(last_rad, positions_m.back() / radius_m_));
    return places;
  }

  double highestSurface() const {
    constexpr int kPlaces = 64;
    double highest_m = 0;
    for (int i = 0; i < kPlaces; ++i)
      highest_m =
          std::max(highest_m, motion_.displacementAt(std::numbers::pi * ((i + 0.5) / kPlaces - 0.5)).ur_m);
    return highest_m;
  }

  const Indenter& indenter_;
  const Tractions& tractions_;
  double approach_m_, radius_m_;
  SurfaceMotion motion_;
  double bulge_m_;
};

/// The smallest gap between two places on either side of one where it is smaller.
std::pair<double, double> deepestBetween(const Gaps& gaps, double from_rad, double to_rad) {
  constexpr int kBits = 24;
  std::uintmax_t most = 40;
  return boost::math::tools::brent_find_minima([&](double angle_rad) { return gaps.at(angle_rad); }, from_rad,
                                               to_rad, kBits, most);
}

/// The deepest place about the i-th, and its gap.
std::pair<double, double> lowestAbout(const Gaps& gaps, const std::vector<double>& places,
                                      const std::vector<double>& values, std::size_t i) {
  const std::pair here{places[i], values[i]};
  if (values[i] > values[i - 1] || values[i] > values[i + 1] || values[i] > gaps.near_m()) return here;
  const std::pair lower = deepestBetween(gaps, places[i - 1], places[i + 1]);
  return lower.second < here.second ? lower : here;
}

/// Those of one stretch; its ends are edges of patches, or of the shape.
void appendOverlaps(const Gaps& gaps, const std::vector<double>& places, double tolerance_m,
                    std::vector<Overlap>& overlaps) {
  std::vector<double> values;
  for (const double place : places) values.push_back(gaps.at(place));
  bool isRunning = false;
  for (std::size_t i = 1; i + 1 < places.size(); ++i) {
    const auto [lowest_rad, lowest_m] = lowestAbout(gaps, places, values, i);
    if (lowest_m < -tolerance_m) {
      if (!isRunning) overlaps.push_back({{}, lowest_rad, 0});
      Overlap& overlap = overlaps.back();
      const double first_rad = isRunning ? overlap.run.first_rad() : (places[i - 1] + places[i]) / 2,
                   last_rad = (places[i] + places[i + 1]) / 2;
      overlap.run = {(first_rad + last_rad) / 2, (last_rad - first_rad) / 2};
      if (-lowest_m > overlap.depth_m) {
        overlap.deepest_rad = lowest_rad;
        overlap.depth_m = -lowest_m;
      }
    }
    isRunning = lowest_m < -tolerance_m;
  }
}

}  // namespace

std::vector<Overlap> findOverlaps(const SurfaceKernel& kernel, const Indenter& indenter,
                                  const Tractions& tractions, double approach_m, double tolerance_m) {
  const Gaps gaps(kernel, indenter, tractions, approach_m);
  std::vector<Overlap> overlaps;
  for (const std::vector<double>& places : gaps.stretches())
    if (places.front() < places.back()) appendOverlaps(gaps, places, tolerance_m, overlaps);
  return overlaps;
}

}  // namespace strainfinger::contact
