// Ways to a contact: flat indenter, frictionless, 2 mm; and what every kind of contact costs.

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "host/bench/model/measured_case.hpp"
#include "host/bench/model/precise.hpp"
#include "host/contact/contact.hpp"
#include "host/contact/paper_method.hpp"

namespace strainfinger::bench {
namespace {

using namespace contact;

constexpr double kWidth_m = 2e-3;
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
        const ContactRequest request{indenter, regime, 0.5, 0, size, {}};
        cases.push_back({"a whole contact", fmt::format("{}, {}, {}", indenterName, sizeName, regimeName),
                         "terms", static_cast<double>(whole(request).terms),
                         std::numeric_limits<double>::quiet_NaN(),
                         [request] { return whole(request).normal_n_per_m; }});
      }
}

PaperContact byPaper(int harmonics, SlopeRows rows) {
  PaperOptions options;
  options.harmonics = harmonics;
  options.cutoff = 1e-3;
  options.rows = rows;
  return solveByPaper(benchAnnulus(), Indenter::flat(), kWidth_m, options);
}

/// Worst error of the pressure over the contact, per peak, against a series of 48 terms (it converges to
/// rounding by 14).
template <typename Pressure>
double errorOf(const Pressure& pressure_pa) {
  constexpr int kPlaces = 200;
  static const Tractions known = spectral(48);
  double worst = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const double angle_rad = kHalf_rad * i / kPlaces;
    worst = std::max(worst, std::abs(pressure_pa(angle_rad) - tractionAt(known, angle_rad).pressure_pa));
  }
  return worst / tractionAt(known, 0).pressure_pa;
}

double errorOf(const Tractions& tractions) {
  return errorOf([&](double angle_rad) { return tractionAt(tractions, angle_rad).pressure_pa; });
}

MeasuredCase paperCase(const char* method, int harmonics, SlopeRows rows) {
  const PaperContact found = byPaper(harmonics, rows);
  const auto pressure = [&](double angle_rad) { return tractionAt(found.tractions, angle_rad).pressure_pa; };
  return {"contact",         method,
          "harmonics",       static_cast<double>(harmonics),
          errorOf(pressure), [=] { return byPaper(harmonics, rows).normal_n_per_m; }};
}

}  // namespace

std::vector<MeasuredCase> contactCases() {
  std::vector<MeasuredCase> cases;
  for (const int terms : {4, 6, 8, 10, 12, 16, 24})
    cases.push_back({"contact", "spectral", "terms", static_cast<double>(terms), errorOf(spectral(terms)),
                     [terms] { return totalTraction(spectral(terms)).pressure_pa; }});
  const ContactRequest flat;
  const Contact found = whole(flat);
  cases.push_back({"contact", "ours (edges, residual too)", "terms", static_cast<double>(found.terms),
                   errorOf(found.tractions), [flat] { return whole(flat).normal_n_per_m; }});
  appendWholeCases(cases);
  for (const int harmonics : {75, 150, 300, 600, 1200})
    cases.push_back(paperCase("paper's, Gauss rows", harmonics, SlopeRows::kGauss));
  cases.push_back(paperCase("paper's, printed rows", 300, SlopeRows::kPrinted));
  return cases;
}

}  // namespace strainfinger::bench
