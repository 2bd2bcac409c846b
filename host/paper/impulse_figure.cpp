// Fig. 4: strain against the angle to a line load, finger and half plane.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/paper/figure_makers.hpp"
#include "host/paper/impulse_curve.hpp"
#include "host/paper/spectrum.hpp"
#include "host/plot/style.hpp"

namespace strainfinger::paper {
namespace {

using model::kNormal;
using model::kTangential;

constexpr int kAnglesEachSide = 1000;

constexpr const char* kImpulsePanels = R"(
set multiplot layout 1,2 margins 0.07,0.985,0.13,0.88 spacing 0.08
set xlabel 'θ (rad)'; set xrange [-1.2:1.2]; set yrange [-1.1:1.1]; set ylabel 'e_{rr} / its peak'
do for [load = 0:1] {
  set label 1 (load == 0 ? 'normal load' : 'tangential load').radialNote at graph 0,1.05 left font ',14'
  cylinder = load == 0 ? cylinderNormal : cylinderTangential; plane = load == 0 ? planeNormal : planeTangential
  plot 0 with lines linecolor rgb faint notitle, \
       data('strains') using 1:(column(2 + load) / cylinder) every ::1 with lines linewidth 1.8 \
         linecolor rgb blue title 'finger', \
       '' using 1:(column(8 + load) / plane) every ::1 with lines dashtype 2 linewidth 1.8 linecolor rgb vermilion \
         title 'half plane, x = r_b θ'
}
unset multiplot
)";

/// Even over all the circle, and closer beside the load where a curve's features are narrower than that.
std::vector<double> anglesFor(double depth_rad) {
  std::vector<double> angles_rad;
  for (int i = -kAnglesEachSide; i <= kAnglesEachSide; ++i)
    angles_rad.push_back(i * std::numbers::pi / kAnglesEachSide);
  double angle_rad = 0;
  while (sampleStep_rad(depth_rad, angle_rad) < std::numbers::pi / kAnglesEachSide) {
    angle_rad += sampleStep_rad(depth_rad, angle_rad);
    angles_rad.insert(angles_rad.end(), {-angle_rad, angle_rad});
  }
  std::ranges::sort(angles_rad);
  return angles_rad;
}

/// A curve's peak, or 1 of one that vanishes: what it is divided by.
double scaleOf(const ImpulseCurve& curve) { return curve.peak() > 0 ? curve.peak() : 1; }

/// Cylinder, then half plane; in each err, ett, ert; of each normal, tangential.
std::vector<ImpulseCurve> allCurves(const Subject& subject) {
  std::vector<ImpulseCurve> curves;
  for (const auto make : {ImpulseCurve::ofCylinder, ImpulseCurve::ofHalfPlane})
    for (const auto component : {StrainComponent::kRadial, StrainComponent::kHoop, StrainComponent::kShear})
      for (const auto load : {kNormal, kTangential})
        curves.push_back(make(subject.annulus, subject.gaugeRadius_m, component, load));
  return curves;
}

Claim halfPlaneAgrees() {
  constexpr double kClaimed_rad = 0.4, kAbout_rad = 0.05;
  const Subject paper = paperSubject();
  const auto part = [&](model::Traction load, double share) {
    return partingAngle_rad(
        ImpulseCurve::ofCylinder(paper.annulus, paper.gaugeRadius_m, StrainComponent::kRadial, load),
        ImpulseCurve::ofHalfPlane(paper.annulus, paper.gaugeRadius_m, StrainComponent::kRadial, load), share);
  };
  const double tangential = part(kTangential, 0.05);
  return {
      "half-plane",
      "under a tangential load e_rr of half plane and cylinder are similar up to 0.4 rad (sec. 3, fig. 4)",
      fmt::format(
          "with x = r_b theta, each over its peak, they first differ by 5 % of it at {:.4f} rad, by 10 % at "
          "{:.4f} rad (under a normal load at {:.4f} and {:.4f} rad)",
          tangential, part(kTangential, 0.1), part(kNormal, 0.05), part(kNormal, 0.1)),
      std::abs(tangential - kClaimed_rad) <= kAbout_rad ? Verdict::kBorneOut : Verdict::kNotBorneOut};
}

}  // namespace

plot::Picture impulsePicture(const Subject& subject) {
  const std::vector<ImpulseCurve> curves = allCurves(subject);
  plot::DataFile data{"strains", {"angle_rad"}, {}};
  for (const char* model : {"cylinder", "half_plane"})
    for (const char* component : {"err", "ett", "ert"})
      for (const char* load : {"normal", "tangential"})
        data.columns.push_back(fmt::format("{}_{}_{}_per_n_per_m", model, component, load));
  for (const double angle_rad : anglesFor(depth_rad(subject.annulus, subject.gaugeRadius_m))) {
    data.rows.push_back({angle_rad});
    for (const ImpulseCurve& curve : curves) data.rows.back().push_back(curve.at(angle_rad));
  }
  const std::string numbers =
      fmt::format("cylinderNormal = {}; cylinderTangential = {}; planeNormal = {}; planeTangential = {}\n",
                  scaleOf(curves[0]), scaleOf(curves[1]), scaleOf(curves[6]), scaleOf(curves[7])) +
      fmt::format("radialNote = '{}'\n", impulseLacks(subject).empty() ? "" : " (finger: 0)");
  return {1300, 560, plot::kStyle + numbers + kImpulsePanels, {std::move(data)}};
}

std::vector<Claim> impulseClaims() {
  std::vector<Claim> claims = locatingClaims();
  claims.insert(claims.begin(), halfPlaneAgrees());
  return claims;
}

std::string impulseLacks(const Subject& subject) {
  if (!vanishes(subject.annulus, subject.gaugeRadius_m, StrainComponent::kRadial)) return {};
  return "the finger's e_rr is 0: " + std::string(kWhyNoRadial) +
         ". It is drawn as 0; the data have e_rt, which isn't";
}

}  // namespace strainfinger::paper
