#include "host/base/chi_squared.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(ChiSquared) {};

// Tables of chi-squared (Abramowitz & Stegun, table 26.8): 12 degrees of freedom, 0.5 and 0.001.
TEST(ChiSquared, QuantilesAreThoseOfTables) {
  DOUBLES_EQUAL(11.3403, chiSquaredQuantile(12, 0), 0.02);
  DOUBLES_EQUAL(32.9095, chiSquaredQuantile(12, 3.0902), 0.2);
}
