#include "host/model/touch_load.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "host/model/impulse_response.hpp"
#include "tests/host/model/fingers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::model;
using namespace strainfinger::testing;

namespace {

constexpr double kLoadedRadius_m = 12.7e-3;

/// A traction over the contact [N/m and rad] at an offset [rad] from its centre.
using Traction = std::function<double(double)>;

/// Integral of f from `low` to `high`, x = middle - half cos(u): square roots at the ends vanish.
double integrate(const Traction& f, double low, double high) {
  const double half = (high - low) / 2, middle = (low + high) / 2;
  const auto inTurns = [&](double u) { return f(middle - half * std::cos(u)) * half * std::sin(u); };
  return boost::math::quadrature::gauss<double, 60>::integrate(inTurns, 0.0, std::numbers::pi);
}

/// Hertz's pressure of a load over the half width a.
double hertz(double load, double a, double x) {
  return std::abs(x) < a ? 2 * load / (std::numbers::pi * a) * std::sqrt(1 - x * x / (a * a)) : 0;
}

/// Mindlin's shear as Johnson (Contact Mechanics, 7.2) has it: mu p0 sqrt(1 - x^2/a^2), and within the stick
/// zone c = a sqrt(1 - Q/(mu P)) less mu p0 c/a sqrt(1 - x^2/c^2).
struct Mindlin {
  double normal, tangential, friction, half_rad;

  double stick_rad() const { return half_rad * std::sqrt(1 - std::abs(tangential) / (friction * normal)); }
  double operator()(double x) const {
    const double peak = 2 * normal / (std::numbers::pi * half_rad), c = stick_rad();
    double shear = std::sqrt(std::max(0.0, 1 - x * x / (half_rad * half_rad)));
    if (std::abs(x) < c) shear -= c / half_rad * std::sqrt(1 - x * x / (c * c));
    return std::copysign(friction * peak * shear, tangential);
  }
  /// Over the pieces that are smooth.
  double integral(const Traction& weight) const {
    const auto f = [&](double x) { return (*this)(x)*weight(x); };
    const double c = stick_rad();
    return integrate(f, -half_rad, -c) + integrate(f, -c, c) + integrate(f, c, half_rad);
  }
};

TouchLoad ellipse(double normal, double tangential, double width_rad, double friction = 0.8) {
  return {normal, tangential, momentOf(Profile::kEllipse, width_rad), Profile::kEllipse, friction};
}

const std::vector<StrainComponent> kEachComponent{StrainComponent::kRadial, StrainComponent::kHoop,
                                                  StrainComponent::kShear};
const std::vector<double> kContactWidths_m{0.5e-3, 2e-3, 6e-3};
const std::vector<double> kFromContact_rad{-0.4, 0.0, 0.13, 1.0};

}  // namespace

TEST_GROUP(TouchLoad) {
  /// Relative to the peak under the pressure, 4.6e-4 a N/m.
  static constexpr double kUnit = 4.6e-4;

  static ImpulseResponse point(StrainComponent component) {
    return {kDefaultFinger, kGaugeRadius_m, component};
  }

  /// Strain under a spectrum, with the slope checked against a difference.
  double under(const ImpulseResponse& response, const LoadSpectrum& spectrum, double angle_rad) {
    constexpr double kStep = 1e-5;
    const auto found = response.under(spectrum, angle_rad);
    const double rise = response.under(spectrum, angle_rad + kStep).strain -
                        response.under(spectrum, angle_rad - kStep).strain;
    DOUBLES_EQUAL(rise / (2 * kStep), found.slope, 1e-8);
    return found.strain;
  }

  void checkSpectra(const LoadSpectrum& expected, const LoadSpectrum& found, double limit) {
    DOUBLES_EQUAL(0, (expected.normal - found.normal).cwiseAbs().maxCoeff(), limit);
    DOUBLES_EQUAL(0, (expected.tangential - found.tangential).cwiseAbs().maxCoeff(), limit);
  }

  /// Central difference of the fitted spectrum to one member of the load.
  LoadSpectrum difference(TouchLoad load, double TouchLoad::*member, double step) {
    TouchLoad less = load;
    load.*member += step;
    less.*member -= step;
    const LoadSpectrum above = fittedSpectrum(load, 60), below = fittedSpectrum(less, 60);
    return {(above.normal - below.normal) / (2 * step), (above.tangential - below.tangential) / (2 * step)};
  }
};

TEST(TouchLoad, LineLoadsGiveTheImpulseResponse) {
  for (const StrainComponent component : kEachComponent) {
    const ImpulseResponse response = point(component);
    for (const double angle_rad : kFromContact_rad) {
      const auto line = response.at(angle_rad);
      const double found = under(response, trueSpectrum({3, -2, 0}, response.harmonics()), angle_rad);
      DOUBLES_EQUAL(3 * line.normal - 2 * line.tangential, found, 1e-14 * kUnit);
    }
  }
}

TEST(TouchLoad, PressuresAreSumsOfLineLoads) {
  for (const StrainComponent component : kEachComponent)
    for (const double width_m : kContactWidths_m)
      for (const double angle_rad : kFromContact_rad) {
        const ImpulseResponse response = point(component);
        const double half = width_m / kLoadedRadius_m / 2;
        const auto pressed = [&](double x) { return hertz(20, half, x) * response.at(angle_rad - x).normal; };
        const auto level = [&](double x) { return 20 / (2 * half) * response.at(angle_rad - x).normal; };
        const TouchLoad uniform{20, 0, momentOf(Profile::kUniform, 2 * half), Profile::kUniform};
        const int last = response.harmonics();
        DOUBLES_EQUAL(integrate(pressed, -half, half),
                      under(response, trueSpectrum(ellipse(20, 0, 2 * half), last), angle_rad),
                      1e-12 * 20 * kUnit);
        DOUBLES_EQUAL(integrate(level, -half, half), under(response, trueSpectrum(uniform, last), angle_rad),
                      1e-12 * 20 * kUnit);
      }
}

TEST(TouchLoad, ShearsInPartialSlipAreSumsOfLineLoads) {
  const ImpulseResponse response = point(StrainComponent::kRadial);
  for (const double width_m : kContactWidths_m)
    for (const double tangential : {0.1, -4.0, 12.0, 15.9})
      for (const double angle_rad : kFromContact_rad) {
        const double half = width_m / kLoadedRadius_m / 2;
        const Mindlin shear{20, tangential, 0.8, half};
        LoadSpectrum spectrum = trueSpectrum(ellipse(20, tangential, 2 * half), response.harmonics());
        spectrum.normal.setZero();
        DOUBLES_EQUAL(shear.integral([&](double x) { return response.at(angle_rad - x).tangential; }),
                      under(response, spectrum, angle_rad), 1e-10 * 20 * kUnit);
      }
}

TEST(TouchLoad, ShearsHaveTheLoadAndTheMomentOfMindlinsTraction) {
  for (const double tangential : {0.1, -4.0, 12.0, 15.9}) {
    const Mindlin shear{20, tangential, 0.8, 0.1};
    const TouchLoad load = ellipse(20, tangential, 0.2);
    DOUBLES_EQUAL(tangential, shear.integral([](double) { return 1.0; }), 1e-6);
    DOUBLES_EQUAL(tangential, trueSpectrum(load, 3).tangential[0], 1e-13);
    const double moment = shear.integral([](double x) { return x * x; }) / tangential;
    DOUBLES_EQUAL(moment, shearMoment_rad2(load), 1e-5 * moment);
  }
}

// Little shear sticks everywhere: 1 / sqrt(a^2 - x^2), whose transform is Bessel's J_0(n a).
TEST(TouchLoad, AShearThatOnlyJustIsSticksAlmostEverywhere) {
  constexpr double kLittle = 1e-5;
  const LoadSpectrum spectrum = trueSpectrum(ellipse(20, kLittle, 0.4), 40);
  for (int n = 0; n <= 40; ++n)
    DOUBLES_EQUAL(::j0(0.2 * n), spectrum.tangential[n] / kLittle, 1e-5);  // of order Q / (mu P)
}

TEST(TouchLoad, WhatSlidesIsSpreadLikeThePressure) {
  for (const double tangential : {16.0, -16.0, 40.0}) {
    const TouchLoad load = ellipse(20, tangential, 0.3);
    const LoadSpectrum spectrum = trueSpectrum(load, 40);
    checkSpectra({spectrum.normal, spectrum.normal * tangential / 20}, spectrum, 1e-13);
    DOUBLES_EQUAL(load.moment_rad2, shearMoment_rad2(load), 1e-18);
  }
  DOUBLES_EQUAL(1, frictionUsed(ellipse(20, 1, 0.3, 0)), 0);  // no friction: nothing holds any shear
  DOUBLES_EQUAL(1, frictionUsed(ellipse(0, 0, 0.3)), 0);
}

TEST(TouchLoad, OtherProfilesSpreadTheShearLikeThePressure) {
  const TouchLoad load{20, 4, 0.01, Profile::kUniform, 0.8};
  const LoadSpectrum spectrum = trueSpectrum(load, 40);
  checkSpectra({spectrum.normal, spectrum.normal / 5}, spectrum, 1e-14);
}

// Harmonics differ from the fourth moment on: below (n a)^4 / 64 of the load.
TEST(TouchLoad, AFitTakesTheTrueTractionsUpToTheSecondMoment) {
  const TouchLoad load = ellipse(20, 7, 0.16);
  const LoadSpectrum exact = trueSpectrum(load, 10), fitted = fittedSpectrum(load, 10);
  for (int n = 0; n <= 10; ++n) {
    DOUBLES_EQUAL(exact.normal[n], fitted.normal[n], 1e-14);
    DOUBLES_EQUAL(exact.tangential[n], fitted.tangential[n], 7 * std::pow(0.08 * n, 4) / 64 + 1e-13);
  }
  CHECK_TRUE(std::abs(exact.tangential[10] - fitted.tangential[10]) > 1e-3);
}

TEST(TouchLoad, SlopesOfTheFitAreItsDerivatives) {
  for (const double tangential : {7.0, -7.0, 1e-3, 30.0}) {
    const TouchLoad load = ellipse(20, tangential, 0.16);
    const auto slopes = fittedSlopes(load, 60);
    checkSpectra(difference(load, &TouchLoad::normal_n_per_m, 1e-4), slopes[0], 1e-8);
    checkSpectra(difference(load, &TouchLoad::tangential_n_per_m, 1e-4), slopes[1], 1e-8);
    checkSpectra(difference(load, &TouchLoad::moment_rad2, 2e-7), slopes[2], 3e-4);  // of 2e4
  }
}

TEST(TouchLoad, SlopesOfTheFitAreThereForALineAndForNoShear) {
  const auto slopes = fittedSlopes(ellipse(20, 0, 0), 10);
  for (int n = 0; n <= 10; ++n) {
    DOUBLES_EQUAL(1, slopes[0].normal[n], 1e-15);
    DOUBLES_EQUAL(1, slopes[1].tangential[n], 1e-15);
    DOUBLES_EQUAL(-20.0 * n * n / 2, slopes[2].normal[n], 1e-11);
    DOUBLES_EQUAL(0, slopes[2].tangential[n], 0);
  }
}
