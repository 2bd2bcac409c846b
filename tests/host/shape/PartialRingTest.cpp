#include "host/shape/partial_ring.hpp"

#include "tests/host/shape/rings.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::shape;
using namespace strainfinger::testing;

TEST_GROUP(PartialRing) {
  const Touch touch{1.3, 20, 4, model::momentOfWidth(3e-3 / kSurface_m)};

  /// Gauges off the drawing, each of a gain of its own, unevenly around the ring.
  static config::FingerConfig ring() {
    config::FingerConfig config = asBuilt(ringOf(0.7, 32));
    for (int i = 0; i < 32; ++i) {
      config.calibration.gain.push_back(1 + 0.01 * i);
      config.gauges.angles_deg.push_back(i * 11.25 + (i % 3));
    }
    return config;
  }
  static std::vector<int> allBut(int gauge, int other) {
    std::vector<int> gauges;
    for (int i = 0; i < 32; ++i)
      if (i != gauge && i != other) gauges.push_back(i);
    return gauges;
  }
};

TEST(PartialRing, ItsGaugesAreWhereTheyWere) {
  const config::FingerConfig whole = ring();
  const std::vector<int> gauges = allBut(0, 7);
  const config::FingerConfig partial = withGauges(whole, gauges);
  LONGS_EQUAL(30, partial.gauges.count);
  for (int k = 0; k < 30; ++k) {
    const model::PlacedGauge was = whole.calibrated(gauges[static_cast<std::size_t>(k)]),
                             is = partial.calibrated(k);
    DOUBLES_EQUAL(was.angle_rad, is.angle_rad, 1e-12);
    DOUBLES_EQUAL(was.radius_m, is.radius_m, 0);
    DOUBLES_EQUAL(was.gain, is.gain, 0);
  }
}

TEST(PartialRing, TellsTheTouchWithoutTheGaugeNextToIt) {
  config::FingerConfig config = ring();
  config.gauges.noise_strain = 1e-6;
  const std::vector<int> gauges = allBut(6, 7);
  const Eigen::VectorXd all = ellipseStrains(config, touch);
  Eigen::VectorXd strains(30);
  for (int k = 0; k < 30; ++k) strains[k] = all[gauges[static_cast<std::size_t>(k)]];
  RingEstimators estimators(config);
  const auto shape = estimators.by(gauges).estimate(strains);
  DOUBLES_EQUAL(touch.angle_rad, shape->angle_rad.value, 1e-5);
  DOUBLES_EQUAL(touch.normal_n_per_m, shape->normal_n_per_m.value, 1e-2);
  DOUBLES_EQUAL(3e-3, shape->width_m->value, 1e-5);
  POINTERS_EQUAL(&estimators.by(gauges), &estimators.by(gauges));
}

// Two thirds of a ring that is not sparse would be one by itself.
TEST(PartialRing, IsNotSparseForTheGaugesThatAreLeftOut) {
  config::FingerConfig config = ringOf(0.7, 16);
  std::vector<int> gauges;
  for (int i = 0; i < 16; ++i)
    if (i % 3 != 2) gauges.push_back(i);
  const config::FingerConfig partial = withGauges(config, gauges);
  CHECK_TRUE(config::isSparse(partial) && !config::isSparse(config));
  RingEstimators estimators(config);
  const auto shape = estimators.by(gauges).estimate(ellipseStrains(partial, touch));
  CHECK_FALSE(shape->isSparse);
  CHECK_TRUE(ShapeEstimator(partial).estimate(ellipseStrains(partial, touch))->isSparse);
}
