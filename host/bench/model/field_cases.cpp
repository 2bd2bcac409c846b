// Ways to a field: stresses, displacements and strains around the gauges' circle.

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "host/base/no_value.hpp"
#include "host/bench/model/measured_case.hpp"
#include "host/bench/model/precise.hpp"
#include "host/model/field.hpp"
#include "host/model/series.hpp"

namespace strainfinger::bench {
namespace {

using namespace model;

constexpr int kAngles = 360;
constexpr SurfaceLoad kLoad{.normal_n_per_m = 1, .tangential_n_per_m = 0.5};
constexpr std::array kAllRows{kTrr, kTrt, kTtt, kUr, kUt, kErr, kEtt, kErt};

const std::vector<double>& angles() {
  static const std::vector<double> angles_rad = [] {
    std::vector<double> made;
    for (int k = 0; k < kAngles; ++k) made.push_back(2 * std::numbers::pi * (k + 0.3) / kAngles);
    return made;
  }();
  return angles_rad;
}

/// Against 50 digits, at every eleventh angle.
double errorOf(const Eigen::MatrixXd& field) {
  constexpr std::size_t kEvery = 11;
  static const Eigen::MatrixXd known = [] {
    std::vector<double> some;
    for (std::size_t k = 0; k < kAngles; k += kEvery) some.push_back(angles()[k]);
    return preciseField(kGauge_m, kLoad, some);
  }();
  Eigen::MatrixXd found(known.rows(), kRowCount);
  for (Eigen::Index k = 0; k < found.rows(); ++k)
    found.row(k) = field.row(k * static_cast<Eigen::Index>(kEvery));
  return worstError(found, known);
}

Eigen::MatrixXd ours(double tolerance, std::span<const Row> rows = kAllRows, const SurfaceLoad& load = kLoad,
                     double radius_m = kGauge_m) {
  return computeField(benchAnnulus(), radius_m, load, angles(), rows, tolerance);
}

/// So many harmonics, needed or not.
template <typename Scalar>
Eigen::MatrixXd fixedSeries(int last) {
  const Annulus<double> annulus = benchAnnulus();
  const HarmonicModel<Scalar> responses({Scalar(annulus.core_radius_m), Scalar(annulus.outer_radius_m),
                                         Scalar(annulus.shear_modulus_pa), Scalar(annulus.poisson_ratio)},
                                        Scalar(kGauge_m));
  Eigen::MatrixX<Scalar> table(last + 1, 2 * kRowCount);
  for (int n = 0; n <= last; ++n) {
    const HarmonicResponse<Scalar> response = responses(n);
    for (int row = 0; row < kRowCount; ++row) table.template block<1, 2>(n, 2 * row) = response.row(row);
  }
  return sumSeries(table, kAllRows, annulus, kLoad, angles()).template cast<double>();
}

template <typename Scalar>
MeasuredCase fixedCase(const char* method, int last) {
  return {
      "field", method, "harmonics", static_cast<double>(last), errorOf(fixedSeries<Scalar>(last)), [last] {
        return fixedSeries<Scalar>(last)(1, 1);
      }};
}

MeasuredCase part(const char* method, const std::function<Eigen::MatrixXd()>& field) {
  return {"saving", method, "angles", kAngles, kNoValue, [field] { return field()(1, 0); }};
}

}  // namespace

std::vector<MeasuredCase> fieldCases() {
  std::vector<MeasuredCase> cases;
  for (const int last : {10, 20, 40, 80, 120, 160, 320}) {
    cases.push_back(fixedCase<double>("fixed harmonics", last));
    cases.push_back(fixedCase<long double>("fixed harmonics, long double", last));
  }
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 1e-15})
    cases.push_back({"field", "ours", "tolerance", tolerance, errorOf(ours(tolerance)),
                     [tolerance] { return ours(tolerance)(1, 1); }});
  // A Taylor-Hood field of one load, 251,000 unknowns, took 16 to 31 s and differed by 1.3e-3 of the peak
  // from a converged collocation: measured for this project, values in tests/data/fem.csv.
  MeasuredCase elements{"field", "finite elements (for scale)", "unknowns", 251e3, 1.3e-3, nullptr};
  elements.time_s = 16;
  cases.push_back(elements);
  return cases;
}

std::vector<Saving> fieldSavings() {
  static constexpr std::array kOneRow{kErr};
  constexpr double kFine = 1e-15, kCoarse = 1e-4, kCore_m = config::Finger{}.core_radius_m;
  const auto whole = part("all rows, tolerance 1e-15", [] { return ours(kFine); });
  return {{"harmonics beyond the tolerance: 1e-4 in place of 1e-15",
           part("tolerance 1e-4", [] { return ours(kCoarse); }), whole},
          {"harmonics beyond the depth: the core in place of 0.6 mm below the surface",
           part("at the core", [] { return ours(kFine, kAllRows, kLoad, kCore_m); }),
           part("near the surface", [] { return ours(kFine, kAllRows, kLoad, 12.1e-3); })},
          {"harmonics beyond both: as many as the gauges need, in place of 2,500", whole,
           part("2,500 harmonics", [] { return fixedSeries<double>(2500); })},
          {"components not asked for: e_rr in place of all eight",
           part("e_rr only", [] { return ours(kFine, kOneRow); }), whole}};
}

}  // namespace strainfinger::bench
