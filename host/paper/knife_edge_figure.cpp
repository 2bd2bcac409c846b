// Fig. 2: where points of the rubber go under a concentrated load at 45 degrees to the surface.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "host/model/field.hpp"
#include "host/model/series.hpp"
#include "host/paper/figure_makers.hpp"
#include "host/plot/style.hpp"

namespace strainfinger::paper {
namespace {

using namespace model;

// The paper gives neither; a load of this size moves the surface visibly, and at the surface itself only one
// of some width has a finite displacement.
constexpr double kLoad_n_per_m = 60;
constexpr double kWidth_m = 0.1e-3;
constexpr double kReach_rad = 0.3;
constexpr int kArcs = 6, kPointsEachSide = 40;
constexpr std::array kDisplacements{kUr, kUt};

constexpr const char* kPanel = R"(
set size ratio -1
set xlabel 'x (m)'; set ylabel 'y (m)'; set key off
set xrange [*:loadX]; set xtics 1e-3; set ytics 1e-3
set arrow 1 from loadX,loadY to tipX,tipY linewidth 2 linecolor rgb vermilion
plot data('points') using 3:4:($5 - $3):($6 - $4) every ::1 with vectors nohead dashtype 3 linecolor rgb faint, \
     '' using 3:4 every ::1 with points pointtype 7 pointsize 0.25 linecolor rgb lightBlue, \
     '' using 5:6 every ::1 with points pointtype 7 pointsize 0.35 linecolor rgb blue
)";

SurfaceLoad knifeEdge(const Annulus<double>& annulus) {
  const double part = kLoad_n_per_m * std::numbers::sqrt2 / 2;
  return {.normal_n_per_m = part, .tangential_n_per_m = part, .width_rad = kWidth_m / annulus.outer_radius_m};
}

/// Share of the displacements' energy in the harmonics above `last`, the turn of the whole left out.
double shareAbove(int last, const Annulus<double>& annulus, double radius_m) {
  constexpr int kHarmonics =
      20'000;  // at the surface they fall like 1 / n: the rest has 2e-4 of what is above 20
  const HarmonicModel<double> responses(annulus, radius_m);
  double below = 0, above = 0;
  for (int n = 1; n <= kHarmonics; ++n) {
    const auto response = responses(n);
    for (const Row row : kDisplacements) (n <= last ? below : above) += response.row(row).squaredNorm();
  }
  return above / (below + above);
}

std::vector<double> pointRow(double r, double angle, double ur, double ut) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {r, angle, r * c, r * s, (r + ur) * c - ut * s, (r + ur) * s + ut * c};
}

}  // namespace

plot::Picture knifeEdgePicture(const Subject& subject) {
  const Annulus<double>& annulus = subject.annulus;
  std::vector<double> angles_rad;
  for (int i = -kPointsEachSide; i <= kPointsEachSide; ++i)
    angles_rad.push_back(i * kReach_rad / kPointsEachSide);
  plot::DataFile data{"points", {"radius_m", "angle_rad", "x_m", "y_m", "deformed_x_m", "deformed_y_m"}, {}};
  const double rubber_m = annulus.outer_radius_m - annulus.core_radius_m;
  for (int arc = 0; arc < kArcs; ++arc) {
    const double r =
        arc == 0 ? annulus.outer_radius_m : annulus.outer_radius_m - rubber_m * arc / (kArcs - 1.0);
    const auto field = computeField(annulus, r, knifeEdge(annulus), angles_rad, kDisplacements);
    for (std::size_t i = 0; i < angles_rad.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      data.rows.push_back(pointRow(r, angles_rad[i], field(k, 0), field(k, 1)));
    }
  }
  const double x = annulus.outer_radius_m, length = rubber_m / 3;
  const std::string numbers =
      fmt::format("loadX = {}; loadY = {}; tipX = {}; tipY = 0\n", x + length, -length, x);
  return {900, 900, plot::kStyle + numbers + kPanel, {std::move(data)}};
}

std::vector<Claim> knifeEdgeClaims() {
  constexpr int kLast = 20;
  const Subject paper = paperSubject();
  const double surface = shareAbove(kLast, paper.annulus, paper.annulus.outer_radius_m);
  const double gauges = shareAbove(kLast, paper.annulus, paper.gaugeRadius_m);
  return {
      {"knife-edge",
       "the displacements under a knife edge at 45 degrees show a large degree of spatial frequency "
       "filtering "
       "(sec. 3, fig. 2)",
       fmt::format(
           "energy of the displacements above the 20th harmonic: {:.2g} of all at the surface, {:.2g} at the "
           "gauges",
           surface, gauges),
       gauges < surface / 10 ? Verdict::kBorneOut : Verdict::kNotBorneOut}};
}

}  // namespace strainfinger::paper
