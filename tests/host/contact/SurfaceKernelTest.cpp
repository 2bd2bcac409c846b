#include "host/contact/surface_kernel.hpp"

#include <cmath>
#include <numbers>

#include "host/model/harmonic.hpp"
#include "host/model/series.hpp"
#include "tests/host/contact/fingers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::contact;
using namespace strainfinger::testing;

TEST_GROUP(SurfaceKernel) {
  struct Sums {
    double normal = 0, coupling = 0, sheared = 0;
  };

  /// The Fourier series themselves, tapered so flatly that 20,000 harmonics have 1e-9 of r_b / mu.
  static Sums seriesAt(const model::Annulus<double>& finger, double angle_rad) {
    constexpr int kLast = 20'000;
    const model::HarmonicModel<double> harmonic(finger, finger.outer_radius_m);
    Sums sums;
    model::visitMultiples(angle_rad, kLast, [&](int n, double c, double s) {
      const auto response = harmonic(n);
      const double taper = std::exp(-36 * std::pow(static_cast<double>(n) / kLast, 8));
      const double factor = taper / std::numbers::pi * (n == 0 ? 0.5 : 1);
      sums.normal += factor * response(model::kUr, model::kNormal) * c;
      sums.coupling += factor * response(model::kUr, model::kTangential) * s;
      sums.sheared += factor * response(model::kUt, model::kTangential) * c;
    });
    return sums;
  }

  static Sums closedAt(const SurfaceKernel& kernel, double angle_rad) {
    const double even = kernel.valuesAt(angle_rad).even, odd = kernel.valuesAt(angle_rad).odd;
    Sums sums{even, odd, even};
    const Reflection& reflection = kernel.reflection();
    for (int n = 0; n < reflection.normal.size(); ++n) {
      const double line = 1 / std::numbers::pi * (n == 0 ? 0.5 : 1);
      sums.normal += line * reflection.normal[n] * std::cos(n * angle_rad);
      sums.coupling += line * reflection.coupling[n] * std::sin(n * angle_rad);
      sums.sheared += line * reflection.sheared[n] * std::cos(n * angle_rad);
    }
    return sums;
  }
};

TEST(SurfaceKernel, IsTheSumOfTheHarmonics) {
  for (const double poissonRatio : {0.5, 0.3, 0.0})
    for (const double angle_rad : {0.1, -0.6, 2.0, -3.1}) {
      const auto finger = fingerOf(0.7, poissonRatio);
      const Sums known = seriesAt(finger, angle_rad), sums = closedAt(SurfaceKernel(finger), angle_rad);
      const double tolerance = 1e-9 * finger.outer_radius_m / finger.shear_modulus_pa;
      DOUBLES_EQUAL(known.normal, sums.normal, tolerance);
      DOUBLES_EQUAL(known.coupling, sums.coupling, tolerance);
      DOUBLES_EQUAL(known.sheared, sums.sheared, tolerance);
    }
}

TEST(SurfaceKernel, PartsAddUpToTheWhole) {
  const SurfaceKernel kernel(fingerOf(0.7, 0.3));
  for (const double angle_rad : {1e-9, -1e-4, 0.003, -0.5, 3.0}) {
    const double log = std::log(std::abs(angle_rad)), sign = angle_rad > 0 ? 1 : -1;
    const KernelParts even = kernel.even(angle_rad), odd = kernel.odd(angle_rad);
    const double rounding = 1e-14 * std::abs(kernel.valuesAt(1e-9).even);
    DOUBLES_EQUAL(kernel.valuesAt(angle_rad).even, even.log * log + even.sgn * sign + even.smooth, rounding);
    DOUBLES_EQUAL(kernel.valuesAt(angle_rad).odd, odd.log * log + odd.sgn * sign + odd.smooth, rounding);
  }
}

TEST(SurfaceKernel, SlopesAreDerivatives) {
  const SurfaceKernel kernel(fingerOf(0.7, 0.3));
  const double step = 1e-5;
  for (const double angle_rad : {-0.5, 0.2, 3.0}) {
    const double even = kernel.valuesAt(angle_rad + step).even - kernel.valuesAt(angle_rad - step).even;
    const double odd = kernel.valuesAt(angle_rad + step).odd - kernel.valuesAt(angle_rad - step).odd;
    DOUBLES_EQUAL(even / (2 * step), kernel.slopesAt(angle_rad).even, -1e-8 * kernel.evenPole());
    DOUBLES_EQUAL(odd / (2 * step), kernel.slopesAt(angle_rad).odd, -1e-8 * kernel.evenPole());
  }
}

TEST(SurfaceKernel, OddJumpsByItsStep) {
  const SurfaceKernel kernel(fingerOf(0.7, 0.3));
  const double jump = kernel.valuesAt(1e-12).odd - kernel.valuesAt(-1e-12).odd;
  DOUBLES_EQUAL(kernel.oddStep(), jump, 1e-9 * std::abs(jump));
  DOUBLES_EQUAL(0, SurfaceKernel(fingerOf(0.7, 0.5)).oddStep(), 0);
}

// tan(pi e) = friction (1 - 2 nu) / (2 - 2 nu), here 0.4 / 1.4.
TEST(SurfaceKernel, FrictionShiftsTheEdgesOfACompressibleRubber) {
  const SurfaceKernel kernel(fingerOf(0.7, 0.3));
  DOUBLES_EQUAL(0.4 / 1.4, std::tan(std::numbers::pi * kernel.edgeShift(1)), 1e-15);
  DOUBLES_EQUAL(-kernel.edgeShift(1), kernel.edgeShift(-1), 0);
  DOUBLES_EQUAL(0, SurfaceKernel(fingerOf(0.7, 0.5)).edgeShift(1), 0);
}
