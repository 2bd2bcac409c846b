#include "host/base/round_scale.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(RoundScale) {};

TEST(RoundScale, EndsAtTheNextOfOneTwoOrFiveTimesAPowerOfTen) {
  DOUBLES_EQUAL(0.1, roundScale(0.1), 0);
  DOUBLES_EQUAL(0.2, roundScale(0.11), 1e-15);
  DOUBLES_EQUAL(5, roundScale(2.01), 0);
  DOUBLES_EQUAL(5, roundScale(5), 0);
  DOUBLES_EQUAL(1000, roundScale(501), 0);
}
