#include "host/simulation/gauge_strains.hpp"

#include <cmath>
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

// Oracle: a uniform pressure is the mean of line loads; 200 midpoints leave (width / 200)^2 / 24 of the
// curvature.
TEST(GaugeStrains, AWideTouchIsManyLines) {
  constexpr double kWidth_m = 3e-3;
  constexpr int kLines = 200;
  std::vector<Touch> lines;
  for (int i = 0; i < kLines; ++i)
    lines.push_back({0.1 + ((i + 0.5) / kLines - 0.5) * kWidth_m / 12.7e-3, 20.0 / kLines, 4.0 / kLines});
  const Strains expected = under(lines);
  const Strains wide = under({{0.1, 20, 4, kWidth_m, model::Profile::kUniform}});
  for (std::size_t gauge = 0; gauge < 16; ++gauge) DOUBLES_EQUAL(expected[gauge], wide[gauge], 2e-8);
  CHECK_TRUE(std::abs(under({{0.1, 20, 4}})[0] - wide[0]) > 1e-4);
}

TEST(GaugeStrains, HertzAndUniformOfOneMomentDifferLittleAndOfOneWidthMuch) {
  const double hertz = under({{0, 20, 0, 2e-3}})[0];
  const double sameMoment = under({{0, 20, 0, 2e-3 * std::sqrt(12.0 / 16), model::Profile::kUniform}})[0];
  const double sameWidth = under({{0, 20, 0, 2e-3, model::Profile::kUniform}})[0];
  CHECK_TRUE(std::abs(hertz - sameMoment) < 0.05 * std::abs(hertz - sameWidth));
}

// A shear of half the friction sticks in the middle: its moment is 3/2 of the pressure's.
TEST(GaugeStrains, FrictionSpreadsTheShearOfAHertzContact) {
  config::FingerConfig slippery;
  slippery.contact.friction_coefficient = 0.5;
  const std::vector<Touch> rubbed{{0.1, 20, 10, 3e-3}}, pressed{{0.1, 20, 0, 3e-3}};
  const GaugeStrains other(slippery);
  CHECK_TRUE(std::abs(other.under(rubbed)[0] - ring.under(rubbed)[0]) > 1e-5);
  DOUBLES_EQUAL(other.under(pressed)[0], ring.under(pressed)[0], 1e-17);
}

TEST(GaugeStrains, ATouchThatDoesntSayHowWideItIsHasTheWidthThatIsKnown) {
  config::FingerConfig known;
  known.contact.width_m = 2e-3;
  const std::vector<Touch> told{{0, 20, 4, 2e-3, model::Profile::kUniform}}, untold{{0, 20, 4}},
      line{{0, 20, 4, 0}};
  const GaugeStrains other(known);
  DOUBLES_EQUAL(ring.under(told)[0], other.under(untold)[0], 1e-17);
  DOUBLES_EQUAL(ring.under(untold)[0], other.under(line)[0], 1e-17);
}

TEST(GaugeStrains, GaugesAreWhereTheFingerWasBuiltNotWhereItWasDrawn) {
  config::FingerConfig glued;
  glued.calibration.angle_offset_deg.assign(16, 0);
  glued.calibration.depth_offset_m.assign(16, 0);
  glued.calibration.angle_offset_deg[1] = 2;
  glued.calibration.depth_offset_m[2] = -3e-4;
  const GaugeStrains other(glued);
  DOUBLES_EQUAL(24.5 * kDeg, other.gaugeAngle_rad(1), 1e-14);
  DOUBLES_EQUAL(-460.6030e-6, other.under(std::vector<Touch>{{24.5 * kDeg, 1, 0}})[1], 1e-10);
  config::FingerConfig shallow;
  shallow.gauges.radius_m = 9.7e-3;
  const std::vector<Touch> press{{45 * kDeg, 1, 0}};
  DOUBLES_EQUAL(GaugeStrains(shallow).under(press)[2], other.under(press)[2], 1e-15);
  DOUBLES_EQUAL(-460.6030e-6, other.at(45 * kDeg, press), 1e-10);
}
