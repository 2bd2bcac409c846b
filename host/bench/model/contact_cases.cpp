// Ways to a contact: flat indenter, frictionless, 2 mm.

#include <cmath>
#include <limits>

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

Contact whole(Regime regime) {
  const SurfaceKernel kernel(benchAnnulus());
  ContactRequest request;
  request.regime = regime;
  request.friction = kFriction;
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
  const Contact found = whole(Regime::kFrictionless);
  cases.push_back({"contact", "ours (edges, residual too)", "terms", static_cast<double>(found.terms),
                   errorOf(found.tractions), [] { return whole(Regime::kFrictionless).normal_n_per_m; }});
  const Contact sliding = whole(Regime::kSliding);
  cases.push_back(
      {"contact", "ours, sliding", "terms", static_cast<double>(sliding.terms),
       errorOf(sliding.tractions, sliding.tractions[0].patch.centre_rad, preciseContact(kWidth_m, kFriction)),
       [] { return whole(Regime::kSliding).normal_n_per_m; }});
  cases.push_back({"contact with friction", "ours, stick", "terms",
                   static_cast<double>(whole(Regime::kStick).terms), std::numeric_limits<double>::quiet_NaN(),
                   [] { return whole(Regime::kStick).normal_n_per_m; }});
  for (const int harmonics : {75, 150, 300, 600, 1200})
    cases.push_back(paperCase("paper's, Gauss rows", harmonics, SlopeRows::kGauss));
  cases.push_back(paperCase("paper's, printed rows", 300, SlopeRows::kPrinted));
  return cases;
}

}  // namespace strainfinger::bench
