#include "host/paper/displaced_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/base/round_scale.hpp"
#include "host/contact/contact_field.hpp"

namespace strainfinger::paper {
namespace {

constexpr double kReach_rad = 0.3;
constexpr int kArcs = 6, kPointsEachSide = 40;
/// As many ticks over the thickness of the rubber at most, and so far apart at least, in radii of the
/// surface: labels of more would overlap.
constexpr double kTicks = 5, kLeastTick = 0.04;

constexpr const char* kDraw = R"(
set size ratio -1
set xlabel 'x (m)'; set ylabel 'y (m)'; set xtics step; set ytics autofreq
plot data('points') using 3:4:($5 - $3):($6 - $4) every ::1 with vectors nohead linewidth 0.7 linecolor rgb faint notitle, \
     '' using 3:4 every ::1 with points pointtype 7 pointsize 0.25 linecolor rgb lightBlue title 'undeformed', \
     '' using 5:6 every ::1 with points pointtype 7 pointsize 0.35 linecolor rgb blue title 'deformed', \
     NaN with lines linewidth 2 linecolor rgb vermilion title applied
)";

std::vector<double> pointRow(double r, double angle, double ur, double ut) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {r, angle, r * c, r * s, (r + ur) * c - ut * s, (r + ur) * s + ut * c};
}

}  // namespace

plot::DataFile displacedPoints(const model::Annulus<double>& annulus, const Displacements& displacements) {
  std::vector<double> angles_rad;
  for (int i = -kPointsEachSide; i <= kPointsEachSide; ++i)
    angles_rad.push_back(i * kReach_rad / kPointsEachSide);
  plot::DataFile data{"points", {"radius_m", "angle_rad", "x_m", "y_m", "deformed_x_m", "deformed_y_m"}, {}};
  const double rubber_m = annulus.outer_radius_m - annulus.core_radius_m;
  // Of thin rubber the next arc would be too near the surface for a sum of harmonics.
  const double deepest_m = contact::fieldLimit_m(annulus) * (1 - 1e-9);
  for (int arc = 0; arc < kArcs; ++arc) {
    const double even_m =
        arc == kArcs - 1 ? annulus.core_radius_m : annulus.outer_radius_m - rubber_m * arc / (kArcs - 1.0);
    const double inner_m = arc == 0 ? even_m : std::min(even_m, deepest_m);
    const Eigen::MatrixXd field = displacements(inner_m, angles_rad);
    for (std::size_t i = 0; i < angles_rad.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      data.rows.push_back(pointRow(inner_m, angles_rad[i], field(k, 0), field(k, 1)));
    }
  }
  return data;
}

std::string drawDisplacedPoints(const model::Annulus<double>& annulus) {
  const double rubber_m = annulus.outer_radius_m - annulus.core_radius_m;
  const double step_m = roundScale(std::max(rubber_m / kTicks, kLeastTick * annulus.outer_radius_m));
  return fmt::format("step = {}\n", step_m) + kDraw;
}

}  // namespace strainfinger::paper
