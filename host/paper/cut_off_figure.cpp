// Fig. 5: cut-off frequencies against the ratio of the radii.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "host/paper/figure_makers.hpp"
#include "host/paper/spectrum.hpp"
#include "host/plot/style.hpp"

namespace strainfinger::paper {
namespace {

constexpr std::array kComponents{StrainComponent::kRadial, StrainComponent::kHoop, StrainComponent::kShear};
constexpr double kFirstAlpha = 0.5, kLastAlpha = 0.95;
constexpr int kAlphas = 91;

constexpr const char* kCutOffPanels = R"(
set multiplot layout 1,2 margins 0.07,0.985,0.13,0.88 spacing 0.08
set xlabel 'α = r_a / r_b'; set ylabel 'cut-off (cycles per revolution)'; set logscale y
plot data('cutoffs') using 1:2 every ::1 with lines linewidth 1.8 linecolor rgb blue title radialTitle('e_{rr}, normal load'), \
     '' using 1:4 every ::1 with lines linewidth 1.8 linecolor rgb vermilion title radialTitle('tangential'), \
     '' using 1:10 every ::1 with lines dashtype 2 linewidth 1.8 linecolor rgb blue title 'e_{rθ}, normal', \
     '' using 1:12 every ::1 with lines dashtype 2 linewidth 1.8 linecolor rgb vermilion title 'tangential'
unset logscale y; set yrange [0:*]
set ylabel 'largest coefficient, tangential / normal'
plot data('cutoffs') using 1:14 every ::1 with lines linewidth 1.8 linecolor rgb black title radialTitle('e_{rr}'), \
     '' using 1:16 every ::1 with lines dashtype 2 linewidth 1.8 linecolor rgb black title 'e_{rθ}'
unset multiplot
)";

/// The subject with another core, its gauges as far above it as before.
Spectra spectraAt(const Subject& subject, double alpha) {
  model::Annulus<double> annulus = subject.annulus;
  annulus.core_radius_m = alpha * annulus.outer_radius_m;
  const double rise_m = subject.gaugeRadius_m - subject.annulus.core_radius_m;
  return cylinderSpectra(annulus, annulus.core_radius_m + rise_m);
}

/// As far as the paper goes, or as leaves a fifth of the gauges' height as rubber above them.
double lastAlpha(const Subject& subject) {
  const double rise_m = subject.gaugeRadius_m - subject.annulus.core_radius_m;
  return std::min(kLastAlpha, 1 - 1.25 * rise_m / subject.annulus.outer_radius_m);
}

std::vector<double> rowAt(const Subject& subject, double alpha) {
  const Spectra spectra = spectraAt(subject, alpha);
  std::vector<double> row{alpha}, ratios;
  for (const StrainComponent component : kComponents) {
    const CutOffs found = cutOffs(spectra, component);
    for (const CutOff& each : {found.normal, found.tangential}) {
      row.push_back(each.interpolated);
      row.push_back(each.last);
    }
    ratios.push_back(found.ratio());
  }
  row.insert(row.end(), ratios.begin(), ratios.end());
  return row;
}

Claim risesSteeply(const Subject& paper) {
  std::array<double, 3> found{};
  constexpr std::array kAt{0.7, 0.85, 0.95};
  for (std::size_t i = 0; i < kAt.size(); ++i)
    found[i] = cutOffs(spectraAt(paper, kAt[i]), StrainComponent::kRadial).normal.interpolated;
  const double before = std::log(found[1] / found[0]) / (kAt[1] - kAt[0]);
  const double after = std::log(found[2] / found[1]) / (kAt[2] - kAt[1]);
  return {
      "cut-off-rises", "the cut-off frequency increases exponentially as alpha approaches 1 (sec. 3, fig. 5)",
      fmt::format(
          "e_rr from a normal load: {:.1f} at alpha = {}, {:.1f} at {}, {:.1f} at {}: by a factor e every "
          "{:.3f} of alpha, then every {:.3f}",
          found[0], kAt[0], found[1], kAt[1], found[2], kAt[2], 1 / before, 1 / after),
      before > 0 && after >= before ? Verdict::kBorneOut : Verdict::kNotBorneOut};
}

Claim shearIsFiltered(const Subject& paper) {
  constexpr double kAlpha = 0.85, kClaimed = 10, kAbout = 1.5;
  const CutOffs shear = cutOffs(spectraAt(paper, kAlpha), StrainComponent::kShear);
  const auto agrees = [](const CutOff& found) { return std::abs(found.interpolated - kClaimed) <= kAbout; };
  const bool normal = agrees(shear.normal), tangential = agrees(shear.tangential);
  return {
      "shear-filtered", "e_rt is filtered to 10 cycles per revolution even at alpha = 0.85 (sec. 3, fig. 5)",
      fmt::format("at {}: {:.2f} (last {}) from a tangential load, but {:.1f} (last {}) from a normal one",
                  kAlpha, shear.tangential.interpolated, shear.tangential.last, shear.normal.interpolated,
                  shear.normal.last),
      normal && tangential   ? Verdict::kBorneOut
      : normal || tangential ? Verdict::kInPart
                             : Verdict::kNotBorneOut};
}

}  // namespace

plot::Picture cutOffPicture(const Subject& subject) {
  plot::DataFile data{"cutoffs", {"alpha"}, {}};
  for (const char* component : {"err", "ett", "ert"})
    for (const char* load : {"p", "q"}) {
      data.columns.push_back(fmt::format("{}_{}", component, load));
      data.columns.push_back(fmt::format("{}_{}_last", component, load));
    }
  for (const char* component : {"err", "ett", "ert"})
    data.columns.push_back(fmt::format("{}_q_over_p", component));
  const double last = lastAlpha(subject), first = std::min(kFirstAlpha, 0.8 * last);
  for (int i = 0; i < kAlphas; ++i)
    data.rows.push_back(rowAt(subject, first + (last - first) * i / (kAlphas - 1)));
  // A curve without a title has no place in the key.
  const bool isDrawn = !vanishes(subject.annulus, subject.gaugeRadius_m, StrainComponent::kRadial);
  const std::string titles = fmt::format("radialTitle(text) = {}\n", isDrawn ? "text" : "''");
  return {1300, 560, plot::kStyle + titles + kCutOffPanels, {std::move(data)}};
}

std::vector<Claim> cutOffClaims() {
  const Subject paper = paperSubject();
  std::vector<Claim> claims = shearClaims();
  claims.insert(claims.begin(), {risesSteeply(paper), shearIsFiltered(paper)});
  return claims;
}

std::string cutOffLacks(const Subject& subject) {
  const auto vanishing = [&](StrainComponent component) {
    return vanishes(subject.annulus, subject.gaugeRadius_m, component);
  };
  if (vanishing(StrainComponent::kRadial))
    return "e_rr is 0 and has no cut-off: " + std::string(kWhyNoRadial) +
           ". e_rt alone is drawn; of the data, the columns err_* and ett_* are empty";
  if (vanishing(StrainComponent::kHoop))
    return "e_tt is 0 and has no cut-off: gauges.radius_m is the core's, which holds the rubber. Of the "
           "data, the columns ett_* are empty";
  return {};
}

}  // namespace strainfinger::paper
