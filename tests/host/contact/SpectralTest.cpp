#include "host/contact/spectral.hpp"

#include <cmath>
#include <numbers>

#include "host/contact/fourier_tractions.hpp"
#include "host/contact/surface_motion.hpp"
#include "tests/host/contact/fingers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::contact;
using namespace strainfinger::testing;

TEST_GROUP(Spectral) {
  const SurfaceKernel kernel{kDefaultFinger};

  PatchSolution flat(int terms, Patch patch, Regime regime = Regime::kFrictionless, double friction = 0)
      const {
    return SpectralSolver(kernel, regime, friction, terms).solve({patch}, Indenter::flat(), 0);
  }

  static double load(const PatchSolution& solution) {
    return kSurface_m * totalTraction(solution.tractions).pressure_pa;
  }

  /// u_r by the harmonics alone: 1e-6 of it is left out of 6,000.
  static double sumOfHarmonics(const Tractions& tractions, double angle_rad) {
    constexpr int kLast = 6'000;
    return surfaceAt(kDefaultFinger, fourierTractions(tractions, kLast), angle_rad).ur_m;
  }
};

TEST(Spectral, ConvergesExponentiallyForASmoothIndenter) {
  const Patch patch{0, 1e-3 / kSurface_m};
  const double known = load(flat(24, patch));
  const auto error = [&](int terms) { return std::abs(load(flat(terms, patch)) / known - 1); };
  CHECK_TRUE(error(4) < 1e-5);
  CHECK_TRUE(error(8) < 1e-9);
  CHECK_TRUE(error(12) < 1e-13);
}

TEST(Spectral, TheTailTellsWhetherItConverged) {
  const Patch wide{0, 6e-3 / kSurface_m};
  CHECK_TRUE(flat(8, wide).tail() > 1e-6);
  CHECK_TRUE(flat(32, wide).tail() < 1e-13);
}

TEST(Spectral, TheHarmonicsOfItsPressureMakeTheIndentersShape) {
  const PatchSolution solution = flat(16, {0, 2e-3 / kSurface_m});
  for (const double angle_rad : {0.0, 0.1, 0.15}) {
    const double wanted = kSurface_m * angle_rad * angle_rad / 2 + solution.lift_m[0];
    DOUBLES_EQUAL(wanted, sumOfHarmonics(solution.tractions, angle_rad), 2e-10);  // of 2e-4 m
  }
}

// Off the normal by c, a flat indenter is one that is turned: its tilt is r_b half c.
TEST(Spectral, AFlatContactOffTheNormalTilts) {
  const PatchSolution solution = flat(16, {0.01, 0.08});
  DOUBLES_EQUAL(-kSurface_m * 0.08 * 0.01, solution.tilt_m[0], 1e-17);
}

TEST(Spectral, TwoPatchesFarApartKnowOfEachOther) {
  const Patch left{-0.1, 0.05}, right{0.1, 0.05};
  const PatchSolution both =
      SpectralSolver(kernel, Regime::kFrictionless, 0, 16).solve({left, right}, Indenter::flat(), 0);
  const SurfaceMotion motion(kernel, both.tractions);
  for (const double x : {-0.7, 0.2, 0.9}) {
    const double angle_rad = right.centre_rad + x * right.half_rad;
    const double wanted = kSurface_m * angle_rad * angle_rad / 2 + both.lift_m[1] + both.tilt_m[1] * x;
    DOUBLES_EQUAL(wanted, motion.at(angle_rad).ur_m, 1e-16);
  }
}

TEST(Spectral, WhatSticksCarriesTheTangentialLoad) {
  const PatchSolution solution =
      SpectralSolver(kernel, Regime::kStick, 0, 16).solve({{0, 0.08}}, Indenter::flat(), 10);
  DOUBLES_EQUAL(10, kSurface_m * totalTraction(solution.tractions).shear_pa, 1e-12);
  const SurfaceMotion motion(kernel, solution.tractions);
  for (const double angle_rad : {-0.07, 0.01, 0.079})
    DOUBLES_EQUAL(solution.shift_m, motion.at(angle_rad).ut_m, 1e-16);
}
