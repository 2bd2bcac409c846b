#include "firmware/core/integers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {

constexpr Number kMost = std::numeric_limits<Number>::max(), kLeast = std::numeric_limits<Number>::min();
constexpr Wide kMostWide = std::numeric_limits<Wide>::max(), kLeastWide = std::numeric_limits<Wide>::min();

}  // namespace

TEST_GROUP(Integers) {
  std::mt19937_64 random{101};
  alignas(4) std::array<std::int16_t, 32> a{}, b{};

  void setup() override { std::printf("seed 101 "); }

  /// Of any size: as many are short as long.
  Wide anyWide() { return static_cast<Wide>(random()) >> (random() % 64); }
  Number anyNumber() { return static_cast<Number>(static_cast<std::uint32_t>(random())) >> (random() % 32); }
  template <typename Check>
  void forManyNumbers(Check check) {
    for (const Number value : {kLeast, kLeast + 1, -1, 0, 1, kMost - 1, kMost}) check(value);
    for (int i = 0; i < 10'000; ++i) check(anyNumber());
  }
  template <typename Check>
  void forManyWides(Check check) {
    for (const Wide value : {kLeastWide, kLeastWide + 1, Wide{-1}, Wide{0}, Wide{1}, kMostWide}) check(value);
    for (int i = 0; i < 10'000; ++i) check(anyWide());
  }
  /// A long double holds 64 bits, so it is exact.
  static void checkShifted(Wide value, int up, Number limit) {
    const long double exact = std::floor(std::ldexp(static_cast<long double>(value), up));
    const long double most = limit;
    LONGS_EQUAL(static_cast<long>(std::clamp(exact, -most, most)), shifted(value, up, limit));
  }
  void fillWith(std::int16_t ofA, std::int16_t ofB) {
    a.fill(ofA);
    b.fill(ofB);
  }
};

TEST(Integers, LimitedIsTheNearestWithinTheLimits) {
  for (const Number limit : {0, 1, 1000, kMost}) {
    forManyNumbers([&](Number value) {
      LONGS_EQUAL(std::max(std::min(Wide{value}, Wide{limit}), -Wide{limit}), limited(value, limit));
    });
    forManyWides([&](Wide value) {
      LONGS_EQUAL(std::max(std::min(value, Wide{limit}), -Wide{limit}), limited(value, limit));
    });
  }
}

TEST(Integers, ScaledIsTheProductRoundedDown) {
  forManyNumbers([&](Number value) {
    const Number factor = anyNumber() / 2;
    const auto exact = std::floor(std::ldexp(static_cast<long double>(value) * factor, -31));
    LONGS_EQUAL(static_cast<long>(exact), scaled<31>(value, factor));
  });
  LONGS_EQUAL(-1, scaled<8>(-1, 1));
  LONGS_EQUAL(7, scaled<0>(7, 1));
}

TEST(Integers, ShiftedRoundsDownAndSaturatesForAnyValueAndShift) {
  forManyWides([&](Wide value) {
    for (int up = -70; up <= 62; ++up) checkShifted(value, up, 1 << (random() % 31));
  });
}

TEST(Integers, ShiftedReachesItsLimitsExactly) {
  for (const Number limit : {0, 1, 5, 6, 7, kMost})
    for (Wide value = -20; value <= 20; ++value)
      for (int up = -3; up <= 3; ++up) checkShifted(value, up, limit);
}

TEST(Integers, SquaresAreExact) {
  forManyNumbers([](Number value) { LONGS_EQUAL(Wide{value} * value, squareOf(value)); });
}

TEST(Integers, MagnitudesAreThoseOfEitherSign) {
  for (const Number value : {0, 1, 12345, kMost}) {
    LONGS_EQUAL(value, magnitude(value));
    LONGS_EQUAL(value, magnitude(-value));
    LONGS_EQUAL(Wide{value} << 30, magnitude(-(Wide{value} << 30)));
  }
}

TEST(Integers, ScalarProductsAreSumsOfProducts) {
  for (int i = 0; i < 1000; ++i) {
    const int count = 4 * static_cast<int>(random() % 9);
    Wide sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      a[k] = static_cast<std::int16_t>(random());
      b[k] = static_cast<std::int16_t>(random());
      a[k] = static_cast<std::int16_t>(a[k] >> 4);
      if (static_cast<int>(k) < count) sum += a[k] * b[k];
    }
    LONGS_EQUAL(sum, dot(a.data(), b.data(), count));
  }
}

TEST(Integers, ScalarProductsHoldTheirLargestSums) {
  fillWith(1 << 12, 1 << 12);
  LONGS_EQUAL(32 << 24, dot(a.data(), b.data(), 32));
  fillWith(-(1 << 12), 1 << 12);
  LONGS_EQUAL(-(32 << 24), dot(a.data(), b.data(), 32));
}
