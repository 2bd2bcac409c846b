// Ways to a contact: flat indenter, frictionless, 2 mm.

#include <cmath>
#include <limits>

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

Contact whole(Regime regime) {
  const SurfaceKernel kernel(benchAnnulus());
  ContactRequest request;
  request.regime = regime;
  request.friction = 0.5;
  request.size.value = kWidth_m;
  return solveContact(kernel, request);
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
  const Contact found = whole(Regime::kFrictionless);
  cases.push_back({"contact", "ours (edges, residual too)", "terms", static_cast<double>(found.terms),
                   errorOf(found.tractions), [] { return whole(Regime::kFrictionless).normal_n_per_m; }});
  for (const Regime regime : {Regime::kSliding, Regime::kStick})
    cases.push_back({"contact with friction", regime == Regime::kStick ? "ours, stick" : "ours, sliding",
                     "terms", static_cast<double>(whole(regime).terms),
                     std::numeric_limits<double>::quiet_NaN(),
                     [regime] { return whole(regime).normal_n_per_m; }});
  for (const int harmonics : {75, 150, 300, 600, 1200})
    cases.push_back(paperCase("paper's, Gauss rows", harmonics, SlopeRows::kGauss));
  cases.push_back(paperCase("paper's, printed rows", 300, SlopeRows::kPrinted));
  return cases;
}

}  // namespace strainfinger::bench
