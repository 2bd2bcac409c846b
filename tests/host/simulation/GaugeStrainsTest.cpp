#include "host/simulation/gauge_strains.hpp"

#include <numbers>
#include <vector>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::simulation;

TEST_GROUP(GaugeStrains) {
  static constexpr double kDeg = std::numbers::pi / 180;
  const config::FingerConfig config;
  const GaugeStrains ring{config};

  Strains under(std::vector<Touch> touches) { return ring.under(touches); }
};

// Oracle: the response of the default finger to 1 N/m from a 60-digit solution, strain to 5 digits.
TEST(GaugeStrains, AnUnitLoadGivesTheKnownStrains) {
  DOUBLES_EQUAL(-460.6030e-6, under({{0, 1, 0}})[0], 1e-10);
  DOUBLES_EQUAL(-307.47e-6, under({{-5 * kDeg, 1, 0}})[0], 1e-8);
  DOUBLES_EQUAL(130.53e-6, under({{2.5 * kDeg, 1, 0}})[1], 1e-8);
  DOUBLES_EQUAL(0.2733e-6, under({{0, 1, 0}})[8], 1e-10);
}

TEST(GaugeStrains, ATouchOverTheNextGaugeMovesThePatternByOne) {
  const Strains first = under({{0, 3, 2}}), second = under({{22.5 * kDeg, 3, 2}});
  for (std::size_t gauge = 0; gauge < 16; ++gauge)
    DOUBLES_EQUAL(first[gauge], second[(gauge + 1) % 16], 1e-15);
}

TEST(GaugeStrains, StrainsOfSeveralTouchesAdd) {
  const Touch a{1.0, 20, -3}, b{3.0, 5, 4};
  const Strains both = under({a, b}), onlyA = under({a}), onlyB = under({b});
  for (std::size_t gauge = 0; gauge < 16; ++gauge)
    DOUBLES_EQUAL(onlyA[gauge] + onlyB[gauge], both[gauge], 1e-17);
}

TEST(GaugeStrains, NothingBeyondTheRingsGaugesAndWithoutTouches) {
  for (std::size_t gauge = 16; gauge < kMaxGauges; ++gauge) DOUBLES_EQUAL(0, under({{0, 10, 5}})[gauge], 0);
  for (const double strain : under({})) DOUBLES_EQUAL(0, strain, 0);
}

TEST(GaugeStrains, TheFirstAngleTurnsTheRing) {
  config::FingerConfig turned;
  turned.gauges.first_angle_deg = 30;
  const GaugeStrains other(turned);
  DOUBLES_EQUAL(30 * kDeg, other.gaugeAngle_rad(0), 1e-15);
  DOUBLES_EQUAL(-460.6030e-6, other.under(std::vector<Touch>{{30 * kDeg, 1, 0}})[0], 1e-10);
}
