// What section 6 says of sensing.

#include <fmt/format.h>

#include "host/paper/figure_makers.hpp"
#include "host/paper/sensing.hpp"

namespace strainfinger::paper {
namespace {

/// The paper's finger with another core, its gauges as far above it as before.
struct Layer {
  model::Annulus<double> annulus = paperSubject().annulus;
  double radius_m;

  explicit Layer(double alpha) {
    const Subject paper = paperSubject();
    annulus.core_radius_m = alpha * annulus.outer_radius_m;
    radius_m = annulus.core_radius_m + paper.gaugeRadius_m - paper.annulus.core_radius_m;
  }
};

}  // namespace

std::vector<Claim> locatingClaims() {
  const Subject paper = paperSubject();
  const auto effect = [&](double width_mm) {
    return widthEffect(paper.annulus, paper.gaugeRadius_m, width_mm * 1e-3);
  };
  const auto share = [&](int gauges) {
    return 100 * ambiguousShare(paper.annulus, paper.gaugeRadius_m, gauges);
  };
  const WidthEffect narrow = effect(1), paperOwn = effect(2), wide = effect(4);
  const double twofold = share(16);
  return {
      {"impulses-vary-little", "the impulse responses vary little with the shape of the indenter (sec. 6)",
       fmt::format(
           "contacts of 1, 2, 4 mm lower the peak by {:.1f}, {:.1f}, {:.0f} %; after the best scaling "
           "{:.1f}, {:.1f}, {:.1f} % of the peak are left",
           100 * narrow.lowersPeak, 100 * paperOwn.lowersPeak, 100 * wide.lowersPeak,
           100 * narrow.differsAtWorst, 100 * paperOwn.differsAtWorst, 100 * wide.differsAtWorst),
       narrow.differsAtWorst < 0.02 && wide.differsAtWorst > 0.05 ? Verdict::kInPart : Verdict::kBorneOut},
      {"three-points",
       "location and direction of the force can be found from 3 data points with 16 sensors around (sec. 6)",
       fmt::format(
           "of noise-free contacts, the three nearest readings have another solution in {:.0f} % with 16 "
           "gauges, {:.1f} % with 24, {:.0f} % with 32: their neighbours have to decide",
           twofold, share(24), share(32)),
       twofold < 1 ? Verdict::kBorneOut : Verdict::kInPart}};
}

std::vector<Claim> discriminationClaims() {
  constexpr double kNarrow_m = 2e-3, kWide_m = 4e-3;
  const Layer thick(0.7), thin(0.85);
  const auto sigma = [](const Layer& layer, int gauges, double width_m) {
    return 100 * widthSigma(layer.annulus, layer.radius_m, gauges, width_m);
  };
  const auto kind = [](const Layer& layer, double width_m) {
    return 100 * kindEffect(layer.annulus, layer.radius_m, width_m);
  };
  const bool helps = sigma(thin, 64, kNarrow_m) < sigma(thick, 64, kNarrow_m);
  const bool helpsAlways = helps && sigma(thin, 16, kNarrow_m) < sigma(thick, 16, kNarrow_m);
  return {
      {"discrimination",
       "good shape discrimination needs alpha > 0.85, or sensors accurate to 1 percent at least (sec. 6)",
       fmt::format(
           "at 1 % of noise the width of a 2 mm contact is known to {:.0f} % by 32 gauges at alpha = 0.7, "
           "to {:.1f} % by 64 at 0.85, but only to {:.0f} % by 16 there: gauges matter as much as depth. "
           "Its kind (punch or ellipse of equal second moment) changes strains by {:.1f} and {:.1f} % of "
           "the peak, at 4 mm by {:.1f} and {:.1f} %",
           sigma(thick, 32, kNarrow_m), sigma(thin, 64, kNarrow_m), sigma(thin, 16, kNarrow_m),
           kind(thick, kNarrow_m), kind(thin, kNarrow_m), kind(thick, kWide_m), kind(thin, kWide_m)),
       helpsAlways ? Verdict::kBorneOut
       : helps     ? Verdict::kInPart
                   : Verdict::kNotBorneOut}};
}

std::vector<Claim> shearClaims() {
  constexpr double kWidth_m = 2e-3, kNoticeable = 0.9;
  constexpr int kGauges = 16;
  const Subject paper = paperSubject();
  const auto sigma = [&](int gauges, bool withShear) {
    return widthSigma(paper.annulus, paper.gaugeRadius_m, gauges, kWidth_m, withShear);
  };
  const double alone = sigma(kGauges, false), shear = sigma(kGauges, true), more = sigma(2 * kGauges, false);
  const bool aids = shear < kNoticeable * alone, aidsMore = shear < more;
  return {
      {"shear-sensing",
       "shear strain sensing will not aid particularly in the inversion, as the tangential load dominates "
       "its low frequencies (sec. 6)",
       fmt::format(
           "at 1 % of noise the width of a 2 mm contact under a normal load is known to {:.1f} % by {} "
           "gauges of e_rr, to {:.1f} % by {} of e_rt besides, to {:.1f} % by as many more of e_rr; the "
           "tangential load is unknown in all",
           100 * alone, kGauges, 100 * shear, kGauges, 100 * more),
       !aids      ? Verdict::kBorneOut
       : aidsMore ? Verdict::kNotBorneOut
                  : Verdict::kInPart}};
}

}  // namespace strainfinger::paper
