#include "host/session/advice.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::session;

TEST_GROUP(Advice) {
  using Kind = session::Advice::Kind;
  config::Gauges gauges;
  session::Coverage coverage{std::vector<int>(32, 10), 10, 5, {40, 130}};
  std::optional<Assessment> assessment = wellKnown();

  static Assessment wellKnown() {
    Assessment known;
    known.gauges.assign(16, {0.005, 1e-6, 0.03, 3e-6});
    known.unitOfForce = 0.005;
    known.zeroOfAngle_deg = 0.1;
    known.arcGains.assign(32, 0.02);
    known.gainAllAround = 0.025;
    known.unitAfterPress.assign(16, 0.004);
    return known;
  }
  session::Advice advice(const Unavailable& unavailable = {}) {
    return nextAdvice(gauges, coverage, assessment, unavailable);
  }
  void advises(Kind kind) { LONGS_EQUAL(static_cast<int>(kind), static_cast<int>(advice().kind)); }
};

TEST(Advice, NothingIsLeftToGainWhenAllIsKnown) { advises(Kind::kDone); }

TEST(Advice, TheFingerIsLeftAloneFirst) {
  coverage = {std::vector<int>(32, 0), 0, 0, {}};
  assessment.reset();
  advises(Kind::kLeaveAlone);
  STRCMP_EQUAL("Leave it alone for 5 s.", textOf(advice(), gauges).c_str());
}

TEST(Advice, ArcsThatAreNotCoveredAreRolledOver) {
  coverage.touches[11] = 3;
  coverage.touches[12] = 0;
  coverage.touches[13] = 1;
  coverage.touches[20] = 0;
  advises(Kind::kRoll);
  STRCMP_EQUAL(
      "Roll it along a table edge from gauge 5 to gauge 7 (112 to 158 deg), with light and with firm "
      "pressure, and rub it to either side.",
      textOf(advice(), gauges).c_str());
}

TEST(Advice, AUnitOfForceThatIsNotKnownWantsAPressWhereItTellsMost) {
  assessment->unitOfForce = 0.02;
  assessment->unitAfterPress[6] = 0.001;
  advises(Kind::kPress);
  LONGS_EQUAL(6, advice().gauge);
  STRCMP_CONTAINS("over gauge 6 (135 deg)", textOf(advice(), gauges).c_str());
}

TEST(Advice, APressThatWouldHardlyTellMoreOfTheUnitOfForceIsNotAskedFor) {
  assessment->unitOfForce = 0.02;
  assessment->unitAfterPress.assign(16, 0.0192);
  advises(Kind::kDone);
  assessment->unitAfterPress[3] = 0.0189;
  advises(Kind::kPress);
}

// As of loads that no touch explains, which are left out of the fit.
TEST(Advice, LoadsThatTellNothingAreNotAskedForWithoutEnd) {
  assessment->unitOfForce = 0.2;
  coverage.loads = 15;
  advises(Kind::kPress);
  coverage.loads = 16;
  advises(Kind::kDone);
}

TEST(Advice, BeforeAFitOneKnownLoadIsEnough) {
  assessment.reset();
  coverage.loads = 0;
  advises(Kind::kPress);
  coverage.loads = 1;
  advises(Kind::kWait);
}

TEST(Advice, TwoDirectionsAreWantedThatAreNotOpposite) {
  for (const std::vector<double>& known : {std::vector<double>{}, {40}, {40, 45}, {40, 220}, {350, 170.0}}) {
    coverage.directions_deg = known;
    advises(Kind::kMark);
  }
  coverage.directions_deg = {40, 220, 100};
  advises(Kind::kDone);
}

TEST(Advice, AZeroOfTheAngleThatIsNotKnownWantsAnotherMark) {
  assessment->zeroOfAngle_deg = 0.3;
  advises(Kind::kMark);
}

TEST(Advice, AZeroThatIsNotKnownWantsItLeftAloneAgain) {
  assessment->gauges[3].zero_strain = 4e-6;  // noise is 6e-6
  advises(Kind::kLeaveAlone);
}

TEST(Advice, WhatCannotBeHadIsNotAskedFor) {
  assessment->unitOfForce = 0.2;
  coverage.directions_deg.clear();
  CHECK(advice({.loads = true}).kind == Kind::kMark);
  CHECK(advice({.loads = true, .directions = true}).kind == Kind::kDone);
}

TEST(Advice, ArcsThatTellMostAreRolledOverWhileThatGains) {
  for (const int arc : {30, 31, 0, 1}) assessment->arcGains[static_cast<std::size_t>(arc)] = 0.08;
  assessment->arcGains[0] = 0.1;
  CHECK(advice() == session::Advice(Kind::kRoll, {30, 4}));
  assessment->arcGains.assign(32, 0.031);
  CHECK(advice() == session::Advice(Kind::kRoll, {0, 32}) || advice().where.count == 32);
}
