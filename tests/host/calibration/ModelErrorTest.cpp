#include "host/calibration/model_error.hpp"

#include <cmath>
#include <random>

#include <CppUTest/TestHarness.h>

using namespace strainfinger::calibration;

TEST_GROUP(ModelError) {
  static constexpr int kTouches = 2000, kFreedom = 12;
  std::mt19937_64 random{20241122};
  std::normal_distribution<double> normal;

  /// Residuals of so much noise and so large an error of peaks from 0.001 to 0.015, and some junk.
  std::vector<Misfit> misfits(double noise, double error, double junk) {
    std::vector<Misfit> all;
    std::uniform_real_distribution<double> peaks(1e-3, 15e-3), chance(0, 1);
    for (int i = 0; i < kTouches; ++i) {
      Misfit misfit{0, peaks(random)};
      const double sigma = std::hypot(noise, error * misfit.peak_strain) * (chance(random) < junk ? 50 : 1);
      for (int k = 0; k < kFreedom; ++k) misfit.squares += std::pow(sigma * normal(random), 2);
      all.push_back(misfit);
    }
    return all;
  }
};

TEST(ModelError, IsWhatResidualsHaveBesideNoise) {
  for (const double error : {0.001, 0.01, 0.05})
    DOUBLES_EQUAL(error, modelErrorOf(misfits(6e-6, error, 0), 6e-6, kFreedom).value, 0.05 * error);
}

TEST(ModelError, IsWithinItsSigmaOfNoneWhereThereIsNone) {
  const Estimate none = modelErrorOf(misfits(6e-6, 0, 0), 6e-6, kFreedom);
  CHECK_COMPARE(none.value, <=, 2 * none.sigma);
  CHECK_COMPARE(none.sigma, <, 5e-4);
}

// A tenth of the touches shifts the median to the 45th part of a hundred of the others.
TEST(ModelError, ATenthOfJunkChangesItByTenPercentAtMost) {
  DOUBLES_EQUAL(0.01, modelErrorOf(misfits(6e-6, 0.01, 0.1), 6e-6, kFreedom).value, 1e-3);
}
