#include "host/model/pressure_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace strainfinger::model {
namespace {

/// In the order of the enumeration.
constexpr std::array kProfiles{Profile::kEllipse, Profile::kUniform, Profile::kWedge, Profile::kPunch};

/// (h^2 / moment) of each.
constexpr double squareOverMoment(Profile profile) {
  switch (profile) {
    case Profile::kEllipse:
      return 4;
    case Profile::kUniform:
      return 3;
    case Profile::kWedge:
      return 6;
    case Profile::kPunch:
      break;
  }
  return 2;
}

/// The power series of the factor in -x^2 / 4, x = n h: coefficient k over coefficient k - 1. From J_m's
/// series, sin x / x and the integral of J_0.
constexpr double coefficientRatio(Profile profile, int k) {
  switch (profile) {
    case Profile::kEllipse:
      return 1.0 / (k * (k + 1.0));
    case Profile::kUniform:
      return 4.0 / (2 * k * (2 * k + 1.0));
    case Profile::kWedge:
      return (2 * k - 1.0) / (1.0 * k * k * (2 * k + 1));
    case Profile::kPunch:
      break;
  }
  return 1.0 / (1.0 * k * k);
}

/// Up to this x^2 the largest term is 30 at most, so cancellation costs two digits of sixteen; the first
/// term that is left out is below 1e-17.
constexpr double kMostBySeries = 40;
constexpr std::size_t kTerms = 24;
using Coefficients = std::array<double, kTerms>;

constexpr Coefficients coefficientsOf(Profile profile) {
  Coefficients coefficients{1};
  for (std::size_t k = 1; k < kTerms; ++k)
    coefficients[k] = coefficients[k - 1] * coefficientRatio(profile, static_cast<int>(k));
  return coefficients;
}

constexpr std::array kCoefficients{coefficientsOf(Profile::kEllipse), coefficientsOf(Profile::kUniform),
                                   coefficientsOf(Profile::kWedge), coefficientsOf(Profile::kPunch)};

/// Value and derivative to x^2 by the series, in Horner's order. Domain: |x^2| <= kMostBySeries.
SpreadFactor bySeries(Profile profile, double square) {
  const Coefficients& coefficients = kCoefficients[static_cast<std::size_t>(profile)];
  const double u = -square / 4;
  double value = 0, slope = 0;
  for (std::size_t k = kTerms; k-- > 0;) {
    slope = slope * u + value;
    value = value * u + coefficients[k];
  }
  return {value, -slope / 4};
}

/// The same below -kMostBySeries, where all terms have one sign: as many as it takes.
SpreadFactor byLongSeries(Profile profile, double square) {
  SpreadFactor factor{1, 0};
  double term = 1;
  for (int k = 1; k < 200; ++k) {
    const double slopeTerm = term * coefficientRatio(profile, k) * -k / 4;
    term *= coefficientRatio(profile, k) * -square / 4;
    factor.value += term;
    factor.slope += slopeTerm;
    if (std::abs(slopeTerm) <= 1e-17 * std::abs(factor.slope)) break;
  }
  return factor;
}

/// (1/x) int_0^x J_0 = (2/x) sum J_(2k+1)(x), by Miller's recurrence downwards, 1 = J_0 + 2 sum J_2k.
double meanOfBessel(double x) {
  const int last = 2 * (static_cast<int>(x) / 2 + 25);
  double above = 0, here = 1e-300, even = 0, odd = 0;
  for (int m = last; m > 0; --m) {
    (m % 2 == 0 ? even : odd) += here;
    const double below = 2 * m / x * here - above;
    above = here;
    here = below;
  }
  return 2 * odd / (x * (here + 2 * even));
}

/// Value and derivative to x.
SpreadFactor inClosedForm(Profile profile, double x) {
  switch (profile) {
    case Profile::kEllipse: {
      const double first = 2 * ::j1(x) / x;
      return {first, 2 * (::j0(x) - first) / x};
    }
    case Profile::kUniform: {
      const double sinc = std::sin(x) / x;
      return {sinc, (std::cos(x) - sinc) / x};
    }
    case Profile::kWedge: {
      const double mean = meanOfBessel(x);
      return {mean, (::j0(x) - mean) / x};
    }
    case Profile::kPunch:
      break;
  }
  return {::j0(x), -::j1(x)};
}

}  // namespace

std::span<const Profile> allProfiles() { return kProfiles; }

const char* nameOf(Profile profile) {
  switch (profile) {
    case Profile::kEllipse:
      return "round";
    case Profile::kUniform:
      return "uniform";
    case Profile::kWedge:
      return "wedge";
    case Profile::kPunch:
      break;
  }
  return "punch";
}

double halfWidth_rad(Profile profile, double moment_rad2) {
  return std::sqrt(squareOverMoment(profile) * moment_rad2);
}

double momentOf(Profile profile, double width_rad) {
  return width_rad * width_rad / 4 / squareOverMoment(profile);
}

double equivalentWidth_rad(double moment_rad2) { return 4 * std::sqrt(std::max(0.0, moment_rad2)); }

double uniformWidth_rad(double moment_rad2) { return std::sqrt(12 * std::max(0.0, moment_rad2)); }

SpreadFactor spreadFactor(Profile profile, int n, double moment_rad2) {
  const double perMoment = squareOverMoment(profile) * n * n, square = perMoment * moment_rad2;
  if (square <= kMostBySeries) {
    const SpreadFactor factor =
        square < -kMostBySeries ? byLongSeries(profile, square) : bySeries(profile, square);
    return {factor.value, factor.slope * perMoment};
  }
  const double x = std::sqrt(square);
  const SpreadFactor factor = inClosedForm(profile, x);
  return {factor.value, factor.slope * perMoment / (2 * x)};
}

double density(Profile profile, double moment_rad2, double offset_rad) {
  const double half_rad = halfWidth_rad(profile, moment_rad2), t = std::abs(offset_rad) / half_rad;
  if (t > 1) return 0;
  const double root = std::sqrt((1 - t) * (1 + t));
  switch (profile) {
    case Profile::kEllipse:
      return 2 * root / (std::numbers::pi * half_rad);
    case Profile::kUniform:
      return 1 / (2 * half_rad);
    case Profile::kWedge:
      return std::acosh(1 / t) / (std::numbers::pi * half_rad);
    case Profile::kPunch:
      break;
  }
  return 1 / (std::numbers::pi * half_rad * root);
}

}  // namespace strainfinger::model
