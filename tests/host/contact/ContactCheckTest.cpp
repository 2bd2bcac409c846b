#include "host/contact/contact_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "host/base/failure.hpp"
#include "host/contact/fourier_tractions.hpp"
#include "tests/host/contact/fingers.hpp"
#include "tests/host/contact/requests.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::contact;
using namespace strainfinger::testing;

namespace {

double loadOf(Regime regime, int terms, double poissonRatio, double width_m) {
  const SurfaceKernel kernel(fingerOf(8.9 / 12.7, poissonRatio));
  const SpectralSolver solver(kernel, regime, 0, terms);
  return totalTraction(solver.solve({{0, width_m / (2 * kSurface_m)}}, Indenter::flat(), 0).tractions)
      .pressure_pa;
}

}  // namespace

TEST_GROUP(ContactCheck) {};

// By Fourier series of the tractions in place of the double exponential rule: 3,000 harmonics leave 1e-9 m.
TEST(ContactCheck, TheResidualIsTheSurfacesDistanceFromTheIndenter) {
  ContactRequest request = sliding(0.5);
  request.centre_rad = 0;
  const Contact contact = solve(request);
  const FourierTractions series = fourierTractions(contact.tractions, 3'000);
  double worst_m = 0;
  for (double x = -0.99; x < 1; x += 0.06) {
    const double angle_rad = x * 1e-3 / kSurface_m;
    const double indenter_m = kSurface_m * angle_rad * angle_rad / 2 - contact.approach_m;
    worst_m = std::max(worst_m, std::abs(surfaceAt(kDefaultFinger, series, angle_rad).ur_m - indenter_m));
  }
  CHECK_TRUE(contact.residual_m < 2 * worst_m && contact.residual_m > worst_m / 2);
}

TEST(ContactCheck, AHeldCentreThatSlidesSaysThatNothingFits) {
  ContactRequest request = sliding(0.5);
  request.centre_rad = 0;
  const Contact contact = solve(request);
  CHECK_TRUE(contact.residual_m > 1e-7);
  LONGS_EQUAL(1, contact.warnings.size());
  STRCMP_CONTAINS("no contact with its centre held there", contact.warnings[0].c_str());
}

TEST(ContactCheck, StickOfACompressibleRubberWarns) {
  const Contact contact = solve(sticking(0), fingerOf(0.7, 0.4));
  STRCMP_CONTAINS("stick below nu = 1/2", contact.warnings.at(0).c_str());
}

TEST(ContactCheck, WhatIsNotResolvedSaysSo) {
  const Contact contact = solve(ofWidth(12e-3), fingerOf(0.99, 0.5));
  CHECK_TRUE(contact.residual_m > 1e-6 * contact.depth_m);
  STRCMP_CONTAINS("inaccurate", contact.warnings.at(0).c_str());
}

// On a half plane p + i q = (x^2 + 2 i e x + c) / sqrt(1 - x^2) ((1 - x) / (1 + x))^(i e), e = ln(3 - 4 nu) /
// 2 pi, with any real c; resolving the edges to a share s of the width makes the pressure there zero: load /
// frictionless load = 1 - 4 e^2 + 4 e tan(e ln 1/s). 12 terms resolve 1/s = exp(7.06), whatever nu is.
TEST(ContactCheck, StickBelowOneHalfCarriesWhatItsEdgesResolutionMakes) {
  for (const double poissonRatio : {0.0, 0.1, 0.2, 0.3, 0.4, 0.45}) {
    const double e = std::log(3 - 4 * poissonRatio) / (2 * std::numbers::pi);
    const double ratio = loadOf(Regime::kStick, 12, poissonRatio, 0.02e-3) /
                         loadOf(Regime::kFrictionless, 12, poissonRatio, 0.02e-3);
    DOUBLES_EQUAL(1 - 4 * e * e + 4 * e * std::tan(7.06 * e), ratio, 0.012 * ratio);  // worst at nu = 0
  }
}

TEST(ContactCheck, StickBelowOneHalfTellsByHowMuchItsLoadIsOpen) {
  for (const double poissonRatio : {0.3, 0.45, 0.49})
    for (const double width_m : {0.02e-3, 0.5e-3, 2e-3, 6e-3}) {
      ContactRequest request = sticking(0);
      request.size.value = width_m;
      const Contact contact = solve(request, fingerOf(8.9 / 12.7, poissonRatio));
      const double finer = loadOf(Regime::kStick, 2 * contact.terms, poissonRatio, width_m) * kSurface_m;
      char told[16];
      std::snprintf(told, sizeof told, "%+.2g %%", 100 * (finer / contact.normal_n_per_m - 1));
      STRCMP_CONTAINS(told, contact.warnings.at(0).c_str());
      CHECK_TRUE(std::abs(finer / contact.normal_n_per_m - 1) < 0.061);  // nu = 0.3, narrow
    }
}

TEST(ContactCheck, StickThatHasNoLoadOfItsOwnIsRefused) {
  for (const double width_m : {0.02e-3, 2e-3, 6e-3}) {
    ContactRequest request = sticking(0);
    request.size.value = width_m;
    CHECK_THROWS(Failure, solve(request, fingerOf(8.9 / 12.7, 0)));
  }
}
