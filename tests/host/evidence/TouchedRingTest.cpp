#include "host/evidence/touched_ring.hpp"

#include <cmath>
#include <limits>
#include <vector>

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::evidence;

TEST_GROUP(TouchedRing) {
  config::FingerConfig config;
  const simulation::Touch touch{0.1, 20, 3, 1e-3};

  double noiseOf(const TouchedRing& ring) {
    const Eigen::VectorXd exact = ring.exact(touch);
    double squares = 0;
    for (std::uint64_t number = 0; number < 2000; ++number)
      squares +=
          (ring.noisy(exact, number) - exact).squaredNorm() / (2000.0 * static_cast<double>(exact.size()));
    return std::sqrt(squares);
  }
};

TEST(TouchedRing, ReadingsHaveTheConfigsNoise) {
  DOUBLES_EQUAL(1, noiseOf(TouchedRing(config, 1)) / 6e-6, 0.02);  // 5 sigma of 32,000 draws
  config.gauges.noise_strain = 5e-5;
  DOUBLES_EQUAL(1, noiseOf(TouchedRing(config, 1)) / 5e-5, 0.02);
}

TEST(TouchedRing, NoiseIsAFunctionOfSeedAndNumber) {
  const TouchedRing ring(config, 1), same(config, 1), other(config, 2);
  const Eigen::VectorXd exact = ring.exact(touch);
  CHECK_TRUE(ring.noisy(exact, 7) == same.noisy(exact, 7));
  CHECK_TRUE(ring.noisy(exact, 7) != ring.noisy(exact, 8));
  CHECK_TRUE(ring.noisy(exact, 7) != other.noisy(exact, 7));
}

TEST(TouchedRing, TouchesAddAndGainsAreIn) {
  const simulation::Touch other{3, 9, -2, 2e-3};
  const TouchedRing ring(config, 1);
  const std::vector<simulation::Touch> both{touch, other};
  CHECK_TRUE((ring.exact(both) - ring.exact(touch) - ring.exact(other)).norm() < 1e-15);
  config.calibration.gain.assign(16, 1.25);
  DOUBLES_EQUAL(1.25, TouchedRing(config, 1).exact(touch)[0] / ring.exact(touch)[0], 1e-12);
}

// A code of 12 bits is 14.6 microstrain, left-justified in 16.
TEST(TouchedRing, CodesAreWhatTheConverterMakesOfIt) {
  const TouchedRing ring(config, 1);
  const Eigen::VectorXd exact = ring.exact(touch);
  double squares = 0;
  for (std::uint64_t number = 0; number < 500; ++number) {
    const auto codes = ring.codes(exact, number);
    LONGS_EQUAL(16, codes.size());
    for (std::size_t gauge = 0; gauge < 16; ++gauge) {
      const double read = (codes[gauge] - 32768.0) / 32768 * config.gauges.full_scale_strain;
      squares += std::pow(read - exact[static_cast<Eigen::Index>(gauge)], 2) / (500 * 16);
    }
  }
  DOUBLES_EQUAL(1, std::sqrt(squares) / 6e-6, 0.15);  // a constant strain's place in its step matters
}

TEST(TouchedRing, ConditionedReadingsAreRoundedToQ32) {
  const Eigen::Vector4d readings(0x1p-31, -1.5 * 0x1p-33, 0.9, -0.9);
  const auto rounded = conditioned_q32(readings);
  LONGS_EQUAL(2, rounded[0]);
  LONGS_EQUAL(-1, rounded[1]);
  LONGS_EQUAL(std::numeric_limits<std::int32_t>::max(), rounded[2]);
  LONGS_EQUAL(std::numeric_limits<std::int32_t>::min(), rounded[3]);
}
