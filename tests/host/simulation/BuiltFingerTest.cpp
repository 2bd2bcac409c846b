#include "host/simulation/built_finger.hpp"

#include <cmath>
#include <functional>
#include <numbers>

#include "host/simulation/gauge_strains.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::simulation;

TEST_GROUP(BuiltFinger) {
  static constexpr double kDeg = std::numbers::pi / 180;
  config::FingerConfig config;

  /// RMS over 2,000 fingers of 16 gauges: 0.4 % of a standard deviation.
  double spreadOf(const std::function<double(const model::PlacedGauge&, int)>& difference) {
    double sum = 0;
    for (config.as_built.seed = 0; config.as_built.seed < 2000; ++config.as_built.seed) {
      const BuiltFinger built = builtFinger(config);
      for (int i = 0; i < 16; ++i)
        sum += std::pow(difference(built.gauges[static_cast<std::size_t>(i)], i), 2) / (2000 * 16);
    }
    return std::sqrt(sum);
  }
};

TEST(BuiltFinger, WithoutDifferencesItIsTheDrawingAndWhatCalibrationFound) {
  config.calibration.gain.assign(16, 1.1);
  config.calibration.angle_offset_deg.assign(16, -1);
  config.calibration.depth_offset_m.assign(16, 1e-4);
  const BuiltFinger built = builtFinger(config);
  LONGS_EQUAL(16, built.gauges.size());
  DOUBLES_EQUAL(21.5 * kDeg, built.gauges[1].angle_rad, 1e-15);
  DOUBLES_EQUAL(9.3e-3, built.gauges[1].radius_m, 1e-17);
  DOUBLES_EQUAL(1.1, built.gauges[1].gain, 0);
  DOUBLES_EQUAL(8.9e-3, built.annulus.core_radius_m, 0);
  DOUBLES_EQUAL(0.5, built.annulus.poisson_ratio, 0);
}

TEST(BuiltFinger, WithDifferencesCalibrationIsNoMoreThanWhatTheFirmwareWasTold) {
  config.calibration.gain.assign(16, 1.1);
  config.as_built.poisson_ratio = -0.01;
  const BuiltFinger built = builtFinger(config);
  DOUBLES_EQUAL(1, built.gauges[1].gain, 0);
  DOUBLES_EQUAL(22.5 * kDeg, built.gauges[1].angle_rad, 1e-15);
  DOUBLES_EQUAL(0.49, built.annulus.poisson_ratio, 1e-15);
}

TEST(BuiltFinger, GaugesSpreadAsAsked) {
  config.as_built = {0, 0.5, 5e-5, 0.03, 1e-4, 0};
  const double angle = spreadOf([&](const auto& gauge, int i) { return gauge.angle_rad / kDeg - 22.5 * i; });
  const double depth = spreadOf([](const auto& gauge, int) { return gauge.radius_m - 9.4e-3; });
  const double gain = spreadOf([](const auto& gauge, int) { return gauge.gain - 1; });
  DOUBLES_EQUAL(1, angle / 0.5, 0.02);  // 5 sigma
  DOUBLES_EQUAL(1, depth / 5e-5, 0.02);
  DOUBLES_EQUAL(1, gain / 0.03, 0.02);
  DOUBLES_EQUAL(9e-3, builtFinger(config).annulus.core_radius_m, 1e-17);
}

TEST(BuiltFinger, TheSeedMakesTheFinger) {
  config.as_built.angle_deg = 0.5;
  config::FingerConfig same = config, other = config;
  other.as_built.seed = 2;
  DOUBLES_EQUAL(builtFinger(config).gauges[3].angle_rad, builtFinger(same).gauges[3].angle_rad, 0);
  CHECK_TRUE(builtFinger(config).gauges[3].angle_rad != builtFinger(other).gauges[3].angle_rad);
  CHECK_TRUE(builtFinger(config).gauges[3].angle_rad !=
             builtFinger(config).gauges[4].angle_rad + 22.5 * kDeg);
}

TEST(BuiltFinger, NoGaugeLeavesTheRubber) {
  config.as_built.depth_m = 0.1;
  const BuiltFinger built = builtFinger(config);
  for (const model::PlacedGauge& gauge : built.gauges) {
    CHECK_TRUE(gauge.radius_m >= 8.9e-3 && gauge.radius_m <= (9.4e-3 + 12.7e-3) / 2);
    CHECK_TRUE(gauge.radius_m == 8.9e-3 || gauge.radius_m > 11e-3);
  }
  GaugeStrains(config).under({});
}

TEST(BuiltFinger, TheRubberThatItIsMadeOfIsFelt) {
  config::FingerConfig softer;
  softer.as_built = {1, 0, 0, 0, 1e-4, -0.01};
  config.finger.core_radius_m = 9e-3;
  config.finger.poisson_ratio = 0.49;
  const Touch press[] = {{0.1, 20, 3}};
  DOUBLES_EQUAL(GaugeStrains(config).under(press)[0], GaugeStrains(softer).under(press)[0], 1e-12);
}
