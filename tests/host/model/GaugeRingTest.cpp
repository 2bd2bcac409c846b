#include "host/model/gauge_ring.hpp"

#include <numbers>

#include "host/model/touch_load.hpp"
#include "tests/host/model/fingers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::model;
using namespace strainfinger::testing;

TEST_GROUP(GaugeRing) {
  const GaugeRing ring{kDefaultFinger,
                       {{0.1, 9.4e-3, 1}, {0.5, 9.4e-3, 1.1}, {0.9, 9.1e-3, 1}, {1.3, 9.4e-3, 1}},
                       StrainComponent::kRadial};
  const TouchLoad load{20, -3, 0.004};
};

// Strain of a single response at that gauge's own distance and depth, times its gain.
TEST(GaugeRing, EachGaugeIsWhereItIsAndReadsWithItsGain) {
  const LoadSpectrum spectrum = trueSpectrum(load, ring.harmonics());
  const auto readings = ring.under(spectrum, 0.45);
  LONGS_EQUAL(4, ring.count());
  for (int i = 0; i < 4; ++i) {
    const PlacedGauge& gauge = ring.gauge(i);
    const ImpulseResponse alone(kDefaultFinger, gauge.radius_m, StrainComponent::kRadial);
    DOUBLES_EQUAL(gauge.gain * alone.under(spectrum, gauge.angle_rad - 0.45).strain, readings.strains[i],
                  1e-17);
  }
  DOUBLES_EQUAL(1.1, ring.gauge(1).gain, 0);
}

TEST(GaugeRing, SlopesAreToThePlaceOfTheLoad) {
  constexpr double kStep_rad = 1e-5;
  const LoadSpectrum spectrum = trueSpectrum(load, ring.harmonics());
  const auto before = ring.under(spectrum, 0.45 - kStep_rad), after = ring.under(spectrum, 0.45 + kStep_rad);
  const auto here = ring.under(spectrum, 0.45);
  for (int i = 0; i < 4; ++i)
    DOUBLES_EQUAL((after.strains[i] - before.strains[i]) / (2 * kStep_rad), here.slopes[i], 1e-8);
}

TEST(GaugeRing, DeeperGaugesFeelFewerHarmonics) {
  const GaugeRing deep{kDefaultFinger, {{0, 9.0e-3, 1}, {1, 8.95e-3, 1}}, StrainComponent::kRadial};
  const ImpulseResponse shallower(kDefaultFinger, 9.0e-3, StrainComponent::kRadial);
  LONGS_EQUAL(shallower.harmonics(), deep.harmonics());
  CHECK_TRUE(deep.harmonics() < ring.harmonics());
}
