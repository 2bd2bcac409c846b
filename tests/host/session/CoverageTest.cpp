#include "host/session/coverage.hpp"

#include "host/session/thinning.hpp"
#include "tests/host/session/hands.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::session;

TEST_GROUP(Coverage) {
  config::FingerConfig config;  // 16 gauges, 22.5 deg apart
  const config::Gauges& gauges = config.gauges;

  int arcAt(double angle_deg) { return arcOf(gauges, angle_deg * kRadPerDeg); }
  std::string named(int first, int length) { return nameOf(gauges, {first, length}); }
};

TEST(Coverage, OverAGaugeIsAQuarterOfTheGapToEitherSide) {
  LONGS_EQUAL(0, arcAt(0));
  LONGS_EQUAL(0, arcAt(5.6));
  LONGS_EQUAL(1, arcAt(5.7));
  LONGS_EQUAL(1, arcAt(16.8));
  LONGS_EQUAL(2, arcAt(16.9));
  LONGS_EQUAL(2, arcAt(22.5));
  LONGS_EQUAL(31, arcAt(-5.7));
  LONGS_EQUAL(0, arcAt(-5.6));
  LONGS_EQUAL(0, arcAt(360));
  LONGS_EQUAL(12, arcAt(135 + 720));
}

TEST(Coverage, TheMiddleOfAnArcIsInIt) {
  config.gauges.angles_deg = {3, 20, 100, 101, 200, 330};
  config.gauges.count = 6;
  for (int arc = 0; arc < 12; ++arc) LONGS_EQUAL(arc, arcOf(gauges, middleOf_rad(gauges, arc)));
}

TEST(Coverage, TheLongestRunGoesAroundTheEnd) {
  CHECK(longestRun({true, false, true, false, true, true}) == ArcRun(4, 3));
  CHECK(longestRun({false, false}) == ArcRun(0, 0));
  CHECK(longestRun({true, true, true}) == ArcRun(0, 3));
}

TEST(Coverage, RunsAreNamedByGaugesAndAngles) {
  STRCMP_EQUAL("over gauge 6 (135 deg)", named(12, 1).c_str());
  STRCMP_EQUAL("between gauges 5 and 6 (112 to 135 deg)", named(11, 1).c_str());
  STRCMP_EQUAL("between gauges 15 and 0 (338 to 0 deg)", named(31, 1).c_str());
  STRCMP_EQUAL("from gauge 3 to gauge 6 (68 to 135 deg)", named(6, 7).c_str());
  STRCMP_EQUAL("all around", named(5, 32).c_str());
}

TEST(Coverage, RowsAreCountedWhereTheyTouch) {
  Hand hand(config);
  Rows rows;
  rows.add(hand.touch(45, 20), {});
  rows.add(hand.touch(56, 20, 5), {std::nullopt, 20, std::nullopt});
  rows.add(hand.touch(90, 20), {90, std::nullopt, std::nullopt});
  rows.add(hand.nothing(), {std::nullopt, 0, 0});
  const session::Coverage coverage = coverageOf(gauges, calibration::drawnSearch(config), rows);
  LONGS_EQUAL(1, coverage.touches[4]);
  LONGS_EQUAL(1, coverage.touches[5]);
  LONGS_EQUAL(1, coverage.touches[8]);
  LONGS_EQUAL(1, coverage.untouched);
  LONGS_EQUAL(1, coverage.loads);
  LONGS_EQUAL(1, coverage.directions_deg.size());
}
