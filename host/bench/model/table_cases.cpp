// Ways to a table of impulse responses.

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "host/base/no_value.hpp"
#include "host/bench/model/measured_case.hpp"
#include "host/bench/model/precise.hpp"
#include "host/model/impulse_response.hpp"
#include "host/model/series.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger::bench {
namespace {

using namespace model;

constexpr int kTableAngles = 1024;
constexpr double kStep_rad = 2 * std::numbers::pi / kTableAngles;

/// Column 0: factors of cos n theta of a normal load; column 1: of sin n theta of a tangential one.
template <typename Scalar>
using Coefficients = Eigen::Matrix<Scalar, Eigen::Dynamic, 2>;

/// A table: per N/m of a normal and of a tangential load.
template <typename Scalar>
using Table = Eigen::Matrix<Scalar, Eigen::Dynamic, 2>;

template <typename Scalar>
Coefficients<Scalar> exactCoefficients(int last) {
  const Annulus<double> annulus = benchAnnulus();
  const HarmonicModel<Scalar> responses({Scalar(annulus.core_radius_m), Scalar(annulus.outer_radius_m),
                                         Scalar(annulus.shear_modulus_pa), Scalar(annulus.poisson_ratio)},
                                        Scalar(kGauge_m));
  Coefficients<Scalar> result(last + 1, 2);
  const Scalar unit = 1 / (std::numbers::pi_v<Scalar> * Scalar(annulus.outer_radius_m));
  for (int n = 0; n <= last; ++n) result.row(n) = unit * responses(n).row(kErr);
  result.row(0) /= 2;
  result.col(kNormal) *= -1;
  return result;
}

/// In the type's own precision; float's by double, so that its errors are those of its sums.
template <typename Scalar>
Coefficients<Scalar> coefficients(int last) {
  if constexpr (std::is_same_v<Scalar, float>)
    return coefficients<double>(last).template cast<float>();
  else
    return exactCoefficients<Scalar>(last);
}

template <typename Scalar>
Table<Scalar> byLibrary(const Coefficients<Scalar>& factors) {
  Table<Scalar> table = Table<Scalar>::Zero(kTableAngles, 2);
  for (int k = 0; k < kTableAngles; ++k)
    for (Eigen::Index n = 0; n < factors.rows(); ++n) {
      const Scalar angle = Scalar(n) * Scalar(kStep_rad) * Scalar(k);
      table(k, 0) += factors(n, 0) * std::cos(angle);
      table(k, 1) += factors(n, 1) * std::sin(angle);
    }
  return table;
}

template <typename Scalar>
Table<Scalar> byRotation(const Coefficients<Scalar>& factors) {
  Table<Scalar> table = Table<Scalar>::Zero(kTableAngles, 2);
  for (int k = 0; k < kTableAngles; ++k)
    visitMultiples(Scalar(k * kStep_rad), static_cast<int>(factors.rows()) - 1,
                   [&](int n, Scalar c, Scalar s) {
                     table(k, 0) += factors(n, 0) * c;
                     table(k, 1) += factors(n, 1) * s;
                   });
  return table;
}

template <typename Scalar>
Table<Scalar> byCosineTable(const Coefficients<Scalar>& factors) {
  std::vector<Scalar> cosines(kTableAngles), sines(kTableAngles);
  for (std::size_t k = 0; k < kTableAngles; ++k) {
    cosines[k] = static_cast<Scalar>(std::cos(kStep_rad * static_cast<double>(k)));
    sines[k] = static_cast<Scalar>(std::sin(kStep_rad * static_cast<double>(k)));
  }
  Table<Scalar> table = Table<Scalar>::Zero(kTableAngles, 2);
  for (std::size_t k = 0; k < kTableAngles; ++k)
    for (std::size_t n = 0; n < static_cast<std::size_t>(factors.rows()); ++n) {
      const std::size_t place = n * k % kTableAngles;
      table(static_cast<Eigen::Index>(k), 0) += factors(static_cast<Eigen::Index>(n), 0) * cosines[place];
      table(static_cast<Eigen::Index>(k), 1) += factors(static_cast<Eigen::Index>(n), 1) * sines[place];
    }
  return table;
}

template <typename Scalar>
Table<Scalar> byClenshaw(const Coefficients<Scalar>& factors) {
  Table<Scalar> table(kTableAngles, 2);
  for (int k = 0; k < kTableAngles; ++k) {
    const Scalar c = std::cos(Scalar(k * kStep_rad)), s = std::sin(Scalar(k * kStep_rad));
    Scalar even = 0, evenBefore = 0, odd = 0, oddBefore = 0;
    for (Eigen::Index n = factors.rows() - 1; n >= 1; --n) {
      even = std::exchange(evenBefore, factors(n, 0) + 2 * c * evenBefore - even);
      odd = std::exchange(oddBefore, factors(n, 1) + 2 * c * oddBefore - odd);
    }
    table(k, 0) = factors(0, 0) + c * evenBefore - even;
    table(k, 1) = s * oddBefore;
  }
  return table;
}

/// Both loads as the two parts of one complex transform, whose coefficients are real.
Table<double> byFft(const Coefficients<double>& factors) {
  std::vector<std::complex<double>> spectrum(kTableAngles), values(kTableAngles);
  for (Eigen::Index n = 0; n < factors.rows(); ++n) {
    const auto place = static_cast<std::size_t>(n);
    spectrum[place] += kTableAngles * (factors(n, 0) + factors(n, 1)) / 2;
    spectrum[(kTableAngles - place) % kTableAngles] += kTableAngles * (factors(n, 0) - factors(n, 1)) / 2;
  }
  Eigen::FFT<double> fft;
  fft.inv(values, spectrum);
  Table<double> table(kTableAngles, 2);
  for (std::size_t k = 0; k < kTableAngles; ++k)
    table.row(static_cast<Eigen::Index>(k)) << values[k].real(), values[k].imag();
  return table;
}

Table<double> byProduct(double tolerance) {
  const ImpulseResponse response(benchAnnulus(), kGauge_m, StrainComponent::kRadial, 0, 0, tolerance);
  Table<double> table(kTableAngles, 2);
  for (int k = 0; k < kTableAngles; ++k) {
    const auto value = response.at(k * kStep_rad);
    table.row(k) << value.normal, value.tangential;
  }
  return table;
}

/// Against 50 digits, at every 31st angle.
double errorOf(const Table<double>& table) {
  constexpr int kEvery = 31;
  static const std::vector<double> angles_rad = [] {
    std::vector<double> angles;
    for (int k = 0; k < kTableAngles; k += kEvery) angles.push_back(k * kStep_rad);
    return angles;
  }();
  static const Eigen::MatrixX2d known = [] {
    Eigen::MatrixX2d both(angles_rad.size(), 2);
    both.col(0) = preciseField(kGauge_m, {.normal_n_per_m = 1}, angles_rad).col(kErr);
    both.col(1) = preciseField(kGauge_m, {.tangential_n_per_m = 1}, angles_rad).col(kErr);
    return both;
  }();
  Eigen::MatrixX2d found(known.rows(), 2);
  for (Eigen::Index k = 0; k < known.rows(); ++k) found.row(k) = table.row(k * kEvery);
  return worstError(found, known);
}

template <typename Scalar, typename Sum>
MeasuredCase harmonicsCase(const char* method, int last, const Sum& sum) {
  const auto make = [last, sum] {
    return Table<double>(sum(coefficients<Scalar>(last)).template cast<double>());
  };
  return {"table",         method,
          "harmonics",     static_cast<double>(last),
          errorOf(make()), [make] { return make()(1, 1); }};
}

}  // namespace

std::vector<MeasuredCase> tableCases() {
  std::vector<MeasuredCase> cases;
  for (const int last : {10, 20, 40, 80, 120, 160, 300}) {
    cases.push_back(harmonicsCase<double>("library's sines", last, byLibrary<double>));
    cases.push_back(harmonicsCase<double>("Clenshaw", last, byClenshaw<double>));
    cases.push_back(harmonicsCase<double>("rotation", last, byRotation<double>));
    cases.push_back(harmonicsCase<double>("sines in a table", last, byCosineTable<double>));
    cases.push_back(harmonicsCase<float>("sines in a table, float", last, byCosineTable<float>));
    cases.push_back(harmonicsCase<long double>("rotation, long double", last, byRotation<long double>));
    cases.push_back(harmonicsCase<double>("FFT", last, byFft));
  }
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 1e-15})
    cases.push_back({"table", "ours (with slopes)", "tolerance", tolerance, errorOf(byProduct(tolerance)),
                     [tolerance] { return byProduct(tolerance)(1, 1); }});
  cases.push_back({"firmware's tables", "ours", "gauges", 16, kNoValue,
                   [] { return static_cast<double>(tables::buildTableImage({}).crc32); }});
  return cases;
}

}  // namespace strainfinger::bench
