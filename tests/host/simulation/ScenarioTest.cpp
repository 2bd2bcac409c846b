#include "host/simulation/scenario.hpp"

#include <cmath>
#include <numbers>

#include <CppUTest/TestHarness.h>

using namespace strainfinger::simulation;

TEST_GROUP(Scenario) {
  const Course ramp{{{0, 10}, {2, 30}, {2, 50}, {4, 50}}};
  const Course one{{{0, 1}}};
  const Course none{{{0, 0}}};

  TouchCourse touch(double start_s, double end_s) { return {start_s, end_s, ramp, one, none}; }
  double angle_deg(const Touch& touch) { return touch.angle_rad * 180 / std::numbers::pi; }
};

TEST(Scenario, ACourseIsStraightBetweenItsPointsAndConstantBeyond) {
  DOUBLES_EQUAL(10, ramp.at(-1), 0);
  DOUBLES_EQUAL(10, ramp.at(0), 0);
  DOUBLES_EQUAL(15, ramp.at(0.5), 1e-14);
  DOUBLES_EQUAL(50, ramp.at(3), 0);
  DOUBLES_EQUAL(50, ramp.at(99), 0);
}

TEST(Scenario, OfTwoPointsAtOneTimeTheLaterCountsFromThereOn) {
  DOUBLES_EQUAL(30, ramp.at(std::nextafter(2.0, 0.0)), 1e-13);
  DOUBLES_EQUAL(50, ramp.at(2), 0);
}

TEST(Scenario, ATouchThatNoFrictionHoldsWhereItPressesMostSlips) {
  const Course press{{{0, 0}, {1, 20}, {2, 0}}}, rub{{{0, 20}, {1, 10}, {2, -20}}};
  const TouchCourse held{0, 2, none, press, rub};
  const Scenario scenario({held, {2, 4, none, press, Course{{{0, -11}}}}});
  const auto slip = scenario.firstSlip(0.5);
  CHECK_TRUE(slip.has_value());
  LONGS_EQUAL(2, slip->number);
  DOUBLES_EQUAL(20, slip->touch.normal_n_per_m, 0);
  DOUBLES_EQUAL(-11, slip->touch.tangential_n_per_m, 0);
  CHECK_FALSE(scenario.firstSlip(0.55).has_value());
  CHECK_FALSE(Scenario({{0, 2, none, none, rub}}).firstSlip(0.5).has_value());
}

TEST(Scenario, ATouchIsInForceFromItsStartUpToItsEnd) {
  const Scenario scenario({touch(1, 3)});
  CHECK_TRUE(scenario.at(std::nextafter(1.0, 0.0)).empty());
  LONGS_EQUAL(1, scenario.at(1).size());
  LONGS_EQUAL(1, scenario.at(std::nextafter(3.0, 0.0)).size());
  CHECK_TRUE(scenario.at(3).empty());
  CHECK_TRUE(scenario.at(-1).empty());
}

TEST(Scenario, CoursesCountTimeFromTheTouchsStart) {
  const auto touches = Scenario({touch(1, 3)}).at(2);
  DOUBLES_EQUAL(20, angle_deg(touches.at(0)), 1e-13);
  DOUBLES_EQUAL(1, touches.at(0).normal_n_per_m, 0);
}

// In doubles 1.2 - 0.9 is a little less than 0.3.
TEST(Scenario, ALoadThatIsOverIsNone) {
  const Course press{{{0, 0}, {0.1, 1}, {0.3, 0}}};
  CHECK_COMPARE(1.2 - 0.9, <, 0.3);
  CHECK_TRUE(Scenario({{0.9, 2, none, press, none}}).at(1.2).empty());
}

TEST(Scenario, OverlappingTouchesAreAllInForce) {
  const Scenario scenario({touch(0, 2), touch(1, 3)});
  LONGS_EQUAL(1, scenario.at(0.5).size());
  LONGS_EQUAL(2, scenario.at(1.5).size());
}

TEST(Scenario, NothingTouchesThatDoesNotPress) {
  CHECK_TRUE(Scenario({{0, 1, ramp, none, none}}).at(0.5).empty());
  CHECK_TRUE(Scenario({{0, 1, ramp, none, one}}).at(0.5).empty());
}

TEST(Scenario, ItBeginsAgainIfItRepeatsAndStaysIdleIfNot) {
  CHECK_TRUE(Scenario({touch(1, 3)}, 4).at(41.5) == Scenario({touch(1, 3)}).at(1.5));
  CHECK_TRUE(Scenario({touch(1, 3)}).at(41.5).empty());
  DOUBLES_EQUAL(4, Scenario({touch(1, 3)}, 4).duration_s(), 0);
  DOUBLES_EQUAL(5, Scenario({touch(1, 5), touch(1, 3)}).duration_s(), 0);
  DOUBLES_EQUAL(0, Scenario({}).duration_s(), 0);
}

TEST(Scenario, NothingTouchesInThePauseBeforeItBeginsAgain) {
  const Scenario scenario({touch(0, 4)}, 4, 2);
  CHECK_FALSE(scenario.at(3.9).empty());
  CHECK_TRUE(scenario.at(4).empty());
  CHECK_TRUE(scenario.at(5.9).empty());
  CHECK_TRUE(scenario.at(6.5) == scenario.at(0.5));
  CHECK_TRUE(scenario.at(60.5) == scenario.at(0.5));
  DOUBLES_EQUAL(4, scenario.duration_s(), 0);
}
