#include "common/fixed.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "common/fixed_real.hpp"
#include "common/quantities.hpp"

using namespace strainfinger;

TEST_GROUP(Fixed) {};

TEST(Fixed, RealNumbersRoundToTheNearestStep) {
  using Q4 = Fixed<4, std::int16_t>;
  LONGS_EQUAL(16, fromReal<Q4>(1.0).raw());
  LONGS_EQUAL(2, fromReal<Q4>(0.1).raw());
  LONGS_EQUAL(-2, fromReal<Q4>(-0.1).raw());
  LONGS_EQUAL(1, fromReal<Q4>(1.0 / 32).raw());
  LONGS_EQUAL(-1, fromReal<Q4>(-1.0 / 32).raw());
}

TEST(Fixed, RealNumbersBeyondTheEndsSaturate) {
  LONGS_EQUAL(StrainQ32::max().raw(), fromReal<StrainQ32>(0.5).raw());
  LONGS_EQUAL(StrainQ32::min().raw(), fromReal<StrainQ32>(-1e300).raw());
  LONGS_EQUAL(StrainQ32::max().raw(), fromReal<StrainQ32>(std::numeric_limits<double>::infinity()).raw());
}

TEST(Fixed, NotANumberBecomesZero) { LONGS_EQUAL(0, fromReal<StrainQ32>(std::nan("")).raw()); }

TEST(Fixed, EveryRawValueOfSixteenBitsSurvivesTheRoundTrip) {
  using Q11 = Fixed<11, std::int16_t>;
  for (int raw = INT16_MIN; raw <= INT16_MAX; ++raw) {
    const auto value = Q11::fromRaw(static_cast<std::int16_t>(raw));
    CHECK(fromReal<Q11>(toReal(value)) == value);
  }
}

TEST(Fixed, HighProductRoundsDown) {
  LONGS_EQUAL(0, mulHigh(1, 1));
  LONGS_EQUAL(-1, mulHigh(-1, 1));
  LONGS_EQUAL(1 << 30, mulHigh(INT32_MIN, INT32_MIN));
  LONGS_EQUAL(-(1 << 30), mulHigh(INT32_MIN, INT32_MAX));
}

TEST(Fixed, NarrowingSaturatesAtBothEnds) {
  LONGS_EQUAL(127, (saturate<std::int8_t>(128)));
  LONGS_EQUAL(-128, (saturate<std::int8_t>(-129)));
  LONGS_EQUAL(-128, (saturate<std::int8_t>(-128)));
  LONGS_EQUAL(5, (saturate<std::int8_t>(5)));
}
