// Ways to a contact: flat indenter, frictionless, 2 mm; and what every kind of contact costs.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/base/no_value.hpp"
#include "host/bench/model/measured_case.hpp"
#include "host/bench/model/precise.hpp"
#include "host/bench/model/precise_contact.hpp"
#include "host/contact/contact.hpp"
#include "host/contact/paper_method.hpp"

namespace strainfinger::bench {
namespace {

using namespace contact;

constexpr double kWidth_m = 2e-3, kFriction = 0.5;
const double kHalf_rad = kWidth_m / 2 / benchAnnulus().outer_radius_m;

/// The kernel included: nothing is kept from one contact to the next.
Tractions spectral(int terms) {
  const SurfaceKernel kernel(benchAnnulus());
  const SpectralSolver solver(kernel, Regime::kFrictionless, 0, terms);
  return solver.solve({{0, kHalf_rad}}, Indenter::flat(), 0).tractions;
}

/// Kernel, edges and residual.
Contact whole(const ContactRequest& request) { return solveContact(SurfaceKernel(benchAnnulus()), request); }

/// A cylinder as a profile measured every 10 um over +-4 mm.
Indenter measuredCylinder(double radius_m) {
  std::vector<double> position_m, height_m;
  for (int i = -400; i <= 400; ++i) {
    position_m.push_back(i * 10e-6);
    height_m.push_back(position_m.back() * position_m.back() / (2 * radius_m));
  }
  return Indenter::measured(position_m, height_m);
}

/// Every indenter by width and by load, frictionless, sliding and sticking: times alone.
void appendWholeCases(std::vector<MeasuredCase>& cases) {
  const std::pair<const char*, Indenter> indenters[] = {{"flat", Indenter::flat()},
                                                        {"cylinder 5 mm", Indenter::cylinder(5e-3)},
                                                        {"wedge 80 deg", Indenter::wedge(80)},
                                                        {"measured", measuredCylinder(5e-3)}};
  const std::pair<const char*, ContactSize> sizes[] = {{"2 mm", {ContactSize::Kind::kWidth, kWidth_m}},
                                                       {"20 N/m", {ContactSize::Kind::kLoad, 20}}};
  const std::pair<const char*, Regime> regimes[] = {
      {"frictionless", Regime::kFrictionless}, {"sliding", Regime::kSliding}, {"stick", Regime::kStick}};
  for (const auto& [indenterName, indenter] : indenters)
    for (const auto& [sizeName, size] : sizes)
      for (const auto& [regimeName, regime] : regimes) {
        const ContactRequest request{indenter, regime, kFriction, 0, size, {}};
        cases.push_back({"a whole contact", fmt::format("{}, {}, {}", indenterName, sizeName, regimeName),
                         "terms", static_cast<double>(whole(request).terms), kNoValue,
                         [request] { return whole(request).normal_n_per_m; }});
      }
}

/// The flat, 2 mm.
ContactRequest flatRequest(Regime regime) {
  return {Indenter::flat(), regime, kFriction, 0, {ContactSize::Kind::kWidth, kWidth_m}, {}};
}

PaperContact byPaper(int harmonics, SlopeRows rows) {
  PaperOptions options;
  options.harmonics = harmonics;
  options.cutoff = 1e-3;
  options.rows = rows;
  return solveByPaper(benchAnnulus(), Indenter::flat(), kWidth_m, options);
}

/// Worst error of the pressure over the contact, per peak, against 50 digits.
template <typename Made>
double errorOf(const Made& tractions, double centre_rad, const PreciseContact& known) {
  double worst = 0;
  for (Eigen::Index i = 0; i < known.angles_rad.size(); ++i) {
    const double found_pa = tractionAt(tractions, centre_rad + known.angles_rad[i]).pressure_pa;
    worst = std::max(worst, std::abs(found_pa - known.pressure_pa[i]));
  }
  return worst / known.pressure_pa.maxCoeff();
}

/// Of a frictionless one.
template <typename Made>
double errorOf(const Made& tractions) {
  static const PreciseContact known = preciseContact(kWidth_m, 0);
  return errorOf(tractions, 0, known);
}

MeasuredCase paperCase(const char* method, int harmonics, SlopeRows rows) {
  const PaperContact found = byPaper(harmonics, rows);
  return {"contact", method, "harmonics", static_cast<double>(harmonics), errorOf(found.tractions), [=] {
            return byPaper(harmonics, rows).normal_n_per_m;
          }};
}

}  // namespace

std::vector<MeasuredCase> contactCases() {
  std::vector<MeasuredCase> cases;
  for (const int terms : {4, 6, 8, 10, 12, 16, 24})
    cases.push_back({"contact", "spectral", "terms", static_cast<double>(terms), errorOf(spectral(terms)),
                     [terms] { return totalTraction(spectral(terms)).pressure_pa; }});
  const ContactRequest flat = flatRequest(Regime::kFrictionless);
  const Contact found = whole(flat);
  cases.push_back({"contact", "ours (edges, residual too)", "terms", static_cast<double>(found.terms),
                   errorOf(found.tractions), [flat] { return whole(flat).normal_n_per_m; }});
  const ContactRequest slidingFlat = flatRequest(Regime::kSliding);
  const Contact sliding = whole(slidingFlat);
  cases.push_back(
      {"contact", "ours, sliding", "terms", static_cast<double>(sliding.terms),
       errorOf(sliding.tractions, sliding.tractions[0].patch.centre_rad, preciseContact(kWidth_m, kFriction)),
       [slidingFlat] { return whole(slidingFlat).normal_n_per_m; }});
  appendWholeCases(cases);
  for (const int harmonics : {75, 150, 300, 600, 1200})
    cases.push_back(paperCase("paper's, Gauss rows", harmonics, SlopeRows::kGauss));
  cases.push_back(paperCase("paper's, printed rows", 300, SlopeRows::kPrinted));
  return cases;
}

}  // namespace strainfinger::bench
