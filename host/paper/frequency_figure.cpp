// Fig. 3: strain coefficients against their index, finger and half plane.

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

constexpr int kClaimedLast = 20;

constexpr const char* kFrequencyPanels = R"(
set multiplot layout 1,2 margins 0.07,0.985,0.13,0.88 spacing 0.08
set xlabel 'harmonic n (cycles per revolution)'; set xrange [0:last]; set yrange [-0.55:1.1]
set ylabel 'coefficient / largest of its model'
set label 2 '10 %' at last,0.1 right offset 0,0.5 textcolor rgb faint
set arrow 1 from 0,0.1 to last,0.1 nohead linecolor rgb faint dashtype 3
set arrow 2 from 0,-0.1 to last,-0.1 nohead linecolor rgb faint dashtype 3
panel(c) = c == 2 ? 'e_{rr}'.radialNote : 'e_{rθ}'
do for [c in '2 6'] {
  set label 1 panel(c + 0) at graph 0,1.05 left font ',14'
  cylinder = c == 2 ? cylinderRadial : cylinderShear; plane = c == 2 ? planeRadial : planeShear
  plot 0 with lines linecolor rgb faint notitle, \
       data('coefficients') using 1:(column(c + 0) / cylinder) every ::1 with linespoints pointtype 7 pointsize 0.5 \
         linewidth 1.4 linecolor rgb blue title 'finger: normal load', \
       '' using 1:(column(c + 1) / cylinder) every ::1 with linespoints pointtype 7 pointsize 0.5 \
         linewidth 1.4 linecolor rgb vermilion title 'tangential', \
       '' using 1:(column(c + 6) / plane) every ::1 with lines dashtype 2 linewidth 1.4 linecolor rgb blue title 'half plane: normal', \
       '' using 1:(column(c + 7) / plane) every ::1 with lines dashtype 2 linewidth 1.4 linecolor rgb vermilion title 'tangential'
}
unset multiplot
)";

/// The largest of a component's coefficients, or 1 of one that vanishes: what they are divided by.
double scaleOf(const Spectra& spectra, StrainComponent component) {
  const CutOffs found = cutOffs(spectra, component);
  const double largest = std::max(found.normal.maximum, found.tangential.maximum);
  return largest > 0 ? largest : 1;
}

int lastHarmonic(const Spectra& spectra) {
  int last = 0;
  for (const auto component : {StrainComponent::kRadial, StrainComponent::kShear}) {
    const CutOffs found = cutOffs(spectra, component);
    last = std::max({last, found.normal.last, found.tangential.last});
  }
  return last;
}

std::vector<std::string> columnNames() {
  std::vector<std::string> names{"n"};
  for (const char* model : {"cylinder", "half_plane"})
    for (const char* component : {"err", "ett", "ert"})
      for (const char* load : {"p", "q"})
        names.push_back(fmt::format("{}_{}_{}_per_pa", model, component, load));
  return names;
}

/// Largest of the shares of their maxima that the responses of both components still have at a harmonic.
double largestShare(const Spectra& spectra, int n, StrainComponent component) {
  double share = 0;
  for (const auto load : {kNormal, kTangential}) {
    const auto values = spectra.col(column(component, load));
    share = std::max(share, std::abs(values[n]) / values.cwiseAbs().maxCoeff());
  }
  return share;
}

std::string list(const CutOffs& found) {
  return fmt::format("{} ({:.2f}) from a normal and {} ({:.2f}) from a tangential load", found.normal.last,
                     found.normal.interpolated, found.tangential.last, found.tangential.interpolated);
}

Claim lastHarmonics(const Spectra& spectra) {
  const CutOffs radial = cutOffs(spectra, StrainComponent::kRadial),
                shear = cutOffs(spectra, StrainComponent::kShear);
  const double left = std::max(largestShare(spectra, kClaimedLast, StrainComponent::kRadial),
                               largestShare(spectra, kClaimedLast, StrainComponent::kShear));
  const int last = lastHarmonic(spectra);
  const Verdict verdict = last < kClaimedLast    ? Verdict::kBorneOut
                          : last == kClaimedLast ? Verdict::kInPart
                                                 : Verdict::kNotBorneOut;
  return {
      "cut-off", "e_rr and e_rt drop below 10 % of their maximum by the 20th coefficient (sec. 3, fig. 3)",
      fmt::format(
          "last harmonic (interpolated) at 10 % or more: e_rr {}; e_rt {}; largest share left at the 20th: "
          "{:.1f} %",
          list(radial), list(shear), 100 * left),
      verdict};
}

Claim comparedLoads(const Spectra& spectra) {
  const double radial = 1 / cutOffs(spectra, StrainComponent::kRadial).ratio();
  const double shear = cutOffs(spectra, StrainComponent::kShear).ratio();
  const bool isTwo = std::max(radial, 1 / radial) <= 2, isThree = std::lround(shear) == 3;
  return {
      "loads-compared",
      "normal and tangential loads act on e_rr within a factor of 2; on e_rt the tangential load is 3 times "
      "as strong (sec. 3, fig. 3)",
      fmt::format("largest coefficients: e_rr normal / tangential {:.2f}; e_rt tangential / normal {:.2f}",
                  radial, shear),
      isTwo && isThree   ? Verdict::kBorneOut
      : isTwo || isThree ? Verdict::kInPart
                         : Verdict::kNotBorneOut};
}

/// Largest magnitude of the opposite sign to the peak, which is at angle 0, over the peak.
double sideLobe(const ImpulseCurve& curve) {
  double lobe = 0;
  for (double angle = 0; angle <= std::numbers::pi; angle += 1e-3)
    lobe = std::max(lobe, -curve.at(angle) / curve.at(0));
  return lobe;
}

Claim halfPlaneFiltersMore(const Subject& paper, const Spectra& spectra) {
  const Spectra plane = halfPlaneSpectra(paper.annulus, paper.gaugeRadius_m);
  const CutOff fingers = cutOffs(spectra, StrainComponent::kRadial).normal,
               planes = cutOffs(plane, StrainComponent::kRadial).normal;
  const auto lobeOf = [&](const auto& make) {
    return sideLobe(make(paper.annulus, paper.gaugeRadius_m, StrainComponent::kRadial, kNormal));
  };
  const double fingersLobe = lobeOf(ImpulseCurve::ofCylinder), planesLobe = lobeOf(ImpulseCurve::ofHalfPlane);
  const bool isLower = planes.interpolated < fingers.interpolated, isSmaller = planesLobe < fingersLobe;
  return {
      "half-plane-filters",
      "the half space filters e_rr from a normal load more: smaller side lobes in the impulse response, a "
      "smaller cut-off frequency in the frequency response (sec. 3, figs. 3 and 4)",
      fmt::format(
          "last harmonic (interpolated) at 10 % or more: half plane {} ({:.2f}), finger {} ({:.2f}); side "
          "lobe over peak: {:.1f} and {:.1f} %",
          planes.last, planes.interpolated, fingers.last, fingers.interpolated, 100 * planesLobe,
          100 * fingersLobe),
      isLower && isSmaller   ? Verdict::kBorneOut
      : isLower || isSmaller ? Verdict::kInPart
                             : Verdict::kNotBorneOut};
}

}  // namespace

plot::Picture frequencyPicture(const Subject& subject) {
  const Spectra cylinder = cylinderSpectra(subject.annulus, subject.gaugeRadius_m);
  const Spectra plane = halfPlaneSpectra(subject.annulus, subject.gaugeRadius_m);
  plot::DataFile data{"coefficients", columnNames(), {}};
  for (Eigen::Index n = 0; n < std::min(cylinder.rows(), plane.rows()); ++n) {
    data.rows.push_back({static_cast<double>(n)});
    for (const Spectra* spectra : {&cylinder, &plane})
      for (const double value : spectra->row(n)) data.rows.back().push_back(value);
  }
  const std::string numbers =
      fmt::format("last = {}; cylinderRadial = {}; cylinderShear = {}; planeRadial = {}; planeShear = {}\n",
                  2 * lastHarmonic(cylinder), scaleOf(cylinder, StrainComponent::kRadial),
                  scaleOf(cylinder, StrainComponent::kShear), scaleOf(plane, StrainComponent::kRadial),
                  scaleOf(plane, StrainComponent::kShear)) +
      fmt::format("radialNote = '{}'\n", frequencyLacks(subject).empty() ? "" : " (finger: 0)");
  return {1300, 560, plot::kStyle + numbers + kFrequencyPanels, {std::move(data)}};
}

std::vector<Claim> frequencyClaims() {
  const Subject paper = paperSubject();
  const Spectra spectra = cylinderSpectra(paper.annulus, paper.gaugeRadius_m);
  return {lastHarmonics(spectra), comparedLoads(spectra), halfPlaneFiltersMore(paper, spectra)};
}

std::string frequencyLacks(const Subject& subject) {
  if (!vanishes(subject.annulus, subject.gaugeRadius_m, StrainComponent::kRadial)) return {};
  return "the finger's e_rr is 0: " + std::string(kWhyNoRadial) + ". Its coefficients are drawn as 0";
}

}  // namespace strainfinger::paper
