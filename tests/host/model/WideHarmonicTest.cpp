#include <cstdio>
#include <random>

#include "host/model/harmonic.hpp"
#include "tests/host/model/fingers.hpp"
#include "tests/host/model/wide.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger::model;
using namespace strainfinger::testing;

TEST_GROUP(WideHarmonic) {};

// The formulas themselves, apart from double's rounding: what is lost of 100 digits is the oracle's own.
TEST(WideHarmonic, AgreesWithStressFunctionsToSeventyDigits) {
  const unsigned seed = std::random_device{}();
  std::printf("seed %u ", seed);
  Sampler sampler(seed, {0.08, 0.9}, {0.3, 0.5}, 2500);
  for (int i = 0; i < 400; ++i) {
    const Sample sample = sampler.next();
    const WideAnnulus finger = widen(sample.finger);
    const auto exact = michellResponse(finger, sample.radius_m, sample.n);
    const auto response = HarmonicModel<Wide>(finger, Wide(sample.radius_m))(sample.n);
    const Wide size = exact.row(kTrr).cwiseAbs().maxCoeff() + exact.row(kTrt).cwiseAbs().maxCoeff();
    const Wide stiffness = 2 * finger.shear_modulus_pa;
    for (int row = 0; row < kRowCount; ++row) {
      const Wide unit = row <= kTtt  ? Wide(1)
                        : row <= kUt ? Wide(sample.radius_m / stiffness)
                                     : 1 / stiffness;
      const Wide error = (response.row(row) - exact.row(row)).cwiseAbs().maxCoeff();
      CHECK_TRUE_TEXT(error < size * unit * Wide("1e-70"), sample.text().c_str());
    }
  }
}
