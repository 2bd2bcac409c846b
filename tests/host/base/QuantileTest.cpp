#include "host/base/quantile.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(Quantile) {};

TEST(Quantile, ThatShareOfTheValuesIsBelow) {
  const std::vector<double> values{5, 1, 4, 2, 3};
  DOUBLES_EQUAL(1, quantileOf(values, 0), 0);
  DOUBLES_EQUAL(3, quantileOf(values, 0.5), 0);
  DOUBLES_EQUAL(5, quantileOf(values, 0.9), 0);
  DOUBLES_EQUAL(5, quantileOf(values, 1), 0);
  DOUBLES_EQUAL(7, quantileOf({7}, 0.5), 0);
}

TEST(Quantile, TheMedianOfAnEvenCountIsTheMeanOfTheTwoInTheMiddle) {
  DOUBLES_EQUAL(2.5, medianOf({4, 1, 3, 2}), 0);
  DOUBLES_EQUAL(2, medianOf({3, 1, 2}), 0);
}
