// Fig. 2: where points of the rubber go under a concentrated load at 45 degrees to the surface.

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "host/model/field.hpp"
#include "host/model/series.hpp"
#include "host/paper/displaced_points.hpp"
#include "host/paper/figure_makers.hpp"
#include "host/plot/style.hpp"

namespace strainfinger::paper {
namespace {

using namespace model;

// The paper gives neither, so these are of its finger; a load of this size moves the surface visibly, and at
// the surface itself only one of some width has a finite displacement.
constexpr double kLoad_n_per_m = 60;
constexpr double kWidth_m = 0.1e-3;

constexpr const char* kLoad = R"(
set xrange [*:loadX]
set arrow 1 from loadX,loadY to tipX,tipY linewidth 2 linecolor rgb vermilion
)";

/// What moves another finger of the same proportions by as much of its radius: that share depends on the load
/// over shear modulus and radius only.
double loadOn_n_per_m(const Annulus<double>& annulus) {
  const Annulus<double> paper = paperSubject().annulus;
  return kLoad_n_per_m * (annulus.shear_modulus_pa / paper.shear_modulus_pa) *
         (annulus.outer_radius_m / paper.outer_radius_m);
}

SurfaceLoad knifeEdge(const Annulus<double>& annulus) {
  const double part = loadOn_n_per_m(annulus) * std::numbers::sqrt2 / 2;
  return {.normal_n_per_m = part,
          .tangential_n_per_m = part,
          .width_rad = kWidth_m / paperSubject().annulus.outer_radius_m};
}

/// Share of the displacements' energy under a line load in the harmonics above `last`, the turn of the whole
/// left out.
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

}  // namespace

plot::Picture knifeEdgePicture(const Subject& subject) {
  const Annulus<double>& annulus = subject.annulus;
  const SurfaceLoad load = knifeEdge(annulus);
  plot::DataFile data = displacedPoints(annulus, [&](double radius_m, std::span<const double> angles_rad) {
    return computeField(annulus, radius_m, load, angles_rad, kDisplacements);
  });
  const double x = annulus.outer_radius_m, length = (x - annulus.core_radius_m) / 3;
  const std::string numbers =
      fmt::format("loadX = {}; loadY = {}; tipX = {}; tipY = 0; applied = '{:.3g} N/m at 45°'\n", x + length,
                  -length, x, loadOn_n_per_m(annulus));
  return {900, 900, plot::kStyle + numbers + kLoad + drawDisplacedPoints(annulus), {std::move(data)}};
}

std::vector<Claim> knifeEdgeClaims() {
  constexpr int kLast = 20;
  const Subject paper = paperSubject();
  const double surface = shareAbove(kLast, paper.annulus, paper.annulus.outer_radius_m);
  const double gauges = shareAbove(kLast, paper.annulus, paper.gaugeRadius_m);
  return {{"knife-edge",
           "the displacements under a knife edge at 45 degrees show a large degree of spatial frequency "
           "filtering (sec. 3, fig. 2)",
           fmt::format("energy of the displacements above the 20th harmonic under a line load, the turn of "
                       "the whole (n = 0) left out: {:.2g} of all at the surface, {:.2g} at the gauges",
                       surface, gauges),
           gauges < surface / 10 ? Verdict::kBorneOut : Verdict::kNotBorneOut}};
}

}  // namespace strainfinger::paper
