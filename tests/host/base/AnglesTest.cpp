#include "host/base/angles.hpp"

#include <cmath>
#include <limits>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(Angles) {};

TEST(Angles, AreTheSameDirectionWithinATurn) {
  for (const double angle_deg : {0.0, 12.5, 359.0}) {
    DOUBLES_EQUAL(angle_deg, withinATurn_deg(angle_deg), 0);
    DOUBLES_EQUAL(angle_deg, withinATurn_deg(angle_deg + 720), 1e-12);
    DOUBLES_EQUAL(angle_deg, withinATurn_deg(angle_deg - 720), 1e-12);
  }
}

TEST(Angles, AWholeTurnAndWhatRoundsToItAreZeroWithoutASign) {
  for (const double angle_deg : {360.0, -360.0, -0.0, -1e-20}) {
    DOUBLES_EQUAL(0, withinATurn_deg(angle_deg), 0);
    CHECK_FALSE(std::signbit(withinATurn_deg(angle_deg)));
  }
}

TEST(Angles, WhatIsNotKnownStaysSo) {
  CHECK_TRUE(std::isnan(withinATurn_deg(std::numeric_limits<double>::quiet_NaN())));
}
