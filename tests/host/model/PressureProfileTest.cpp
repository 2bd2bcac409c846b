#include "host/model/pressure_profile.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger::model;

namespace {

/// Integral of density * f over x = half sin^3(u): roots at the edges and a logarithm in the middle vanish.
template <typename Function>
double integral(Profile profile, double moment, Function f) {
  constexpr int kSteps = 4000;
  const double half = halfWidth_rad(profile, moment), step = std::numbers::pi / kSteps;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double turn = -std::numbers::pi / 2 + (i + 0.5) * step, sine = std::sin(turn);
    const double x = half * std::pow(sine, 3);
    sum += density(profile, moment, x) * f(x) * half * 3 * sine * sine * std::cos(turn) * step;
  }
  return sum;
}

double transformed(Profile profile, double moment, int n) {
  return integral(profile, moment, [n](double x) { return std::cos(n * x); });
}

}  // namespace

TEST_GROUP(PressureProfile) {};

TEST(PressureProfile, DensitiesHaveTheLoadAndTheMomentAskedFor) {
  for (const Profile profile : allProfiles()) {
    DOUBLES_EQUAL(1, transformed(profile, 0.02, 0), 1e-6);  // midpoint rule
    DOUBLES_EQUAL(0.02, integral(profile, 0.02, [](double x) { return x * x; }), 1e-7);
  }
}

TEST(PressureProfile, FactorsAreTheDensitiesFourierTransforms) {
  for (const Profile profile : allProfiles())
    for (const int n : {0, 1, 7, 13, 60, 140})
      DOUBLES_EQUAL(transformed(profile, 0.02, n), spreadFactor(profile, n, 0.02).value, 1e-6);
}

// The closed forms take over from the series where (n h)^2 = 40, another series below -40.
TEST(PressureProfile, FactorsAreSmooth) {
  for (const Profile profile : allProfiles())
    for (const double square : {40.0, -40.0}) {
      const double h = halfWidth_rad(profile, 1), change = square / (h * h);
      const double before = change * (1 - 1e-13), behind = change * (1 + 1e-13);
      const SpreadFactor below = spreadFactor(profile, 1, before);
      const SpreadFactor above = spreadFactor(profile, 1, behind);
      const double larger = std::max(1.0, std::abs(below.value));
      DOUBLES_EQUAL(below.value + below.slope * (behind - before), above.value, 2e-13 * larger);
      DOUBLES_EQUAL(below.slope, above.slope, 1e-12 * larger);
    }
}

// mpmath at 40 digits: 2 J_1(x) / x, sin x / x, the integral of J_0 over x, and J_0, x^2 = 39 and 41.
TEST(PressureProfile, FactorsAreExactOnBothSidesOfTheSeries) {
  const auto check = [](Profile profile, double below, double above) {
    const double h = halfWidth_rad(profile, 1);
    DOUBLES_EQUAL(below, spreadFactor(profile, 1, 39 / (h * h)).value, 1e-14);
    DOUBLES_EQUAL(above, spreadFactor(profile, 1, 41 / (h * h)).value, 1e-14);
  };
  check(Profile::kEllipse, -0.0710844752832789571, -0.0564686916709254979);
  check(Profile::kUniform, -0.00611337717477381662, 0.018686436816934712);
  check(Profile::kWedge, 0.120242925902056578, 0.122915676343966625);
  check(Profile::kPunch, 0.21198290300357617, 0.243876756873418435);
}

TEST(PressureProfile, SlopesAreDerivatives) {
  for (const Profile profile : allProfiles())
    for (const double moment : {-1e-3, 0.0, 1e-4, 0.01, 0.05}) {
      const int n = 11;
      const double step = 1e-6;
      const double difference =
          spreadFactor(profile, n, moment + step).value - spreadFactor(profile, n, moment - step).value;
      DOUBLES_EQUAL(difference / (2 * step), spreadFactor(profile, n, moment).slope, 1e-4);  // of 60
    }
}

// 1 - n^2 moment / 2 + ...: all profiles of one moment are the same to a gauge that is deep enough.
TEST(PressureProfile, TheMomentIsWhatTheyHaveInCommon) {
  for (const Profile profile : allProfiles()) {
    DOUBLES_EQUAL(-0.5 * 9, spreadFactor(profile, 3, 0).slope, 1e-14);
    DOUBLES_EQUAL(1, spreadFactor(profile, 3, 0).value, 0);
  }
}

// I_1(y) 2 / y at y = 2: 1.590636854637329 (Abramowitz & Stegun, table 9.8).
TEST(PressureProfile, IsContinuedBelowNoWidth) {
  DOUBLES_EQUAL(1.590636854637329, spreadFactor(Profile::kEllipse, 10, -0.01).value, 1e-14);
}

TEST(PressureProfile, NothingPressesOutside) {
  for (const Profile profile : allProfiles())
    DOUBLES_EQUAL(0, density(profile, 0.01, 1.0001 * halfWidth_rad(profile, 0.01)), 0);
}

// Textbook second moments over the full width w: w^2 / 16, w^2 / 12.
TEST(PressureProfile, MomentsOfAWidthAreTheTextbooks) {
  DOUBLES_EQUAL(0.09 / 16, momentOf(Profile::kEllipse, 0.3), 1e-17);
  DOUBLES_EQUAL(0.09 / 12, momentOf(Profile::kUniform, 0.3), 1e-17);
  for (const Profile profile : allProfiles())
    DOUBLES_EQUAL(0.15, halfWidth_rad(profile, momentOf(profile, 0.3)), 1e-16);
}

TEST(PressureProfile, EquivalentWidthsAreTheEllipses) {
  DOUBLES_EQUAL(2 * halfWidth_rad(Profile::kEllipse, 0.01), equivalentWidth_rad(0.01), 1e-15);
  DOUBLES_EQUAL(0.01, momentOfWidth(equivalentWidth_rad(0.01)), 1e-17);
  DOUBLES_EQUAL(0, equivalentWidth_rad(-0.01), 0);
}

TEST(PressureProfile, HasNames) {
  for (const Profile profile : allProfiles()) CHECK_TRUE(std::strlen(nameOf(profile)) > 3);
  STRCMP_EQUAL("round", nameOf(Profile::kEllipse));
}
