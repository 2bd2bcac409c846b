#include "firmware/core/units.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include <CppUTest/TestHarness.h>

using namespace strainfinger::firmware;

TEST_GROUP(Units) {
  std::mt19937_64 random{102};

  void setup() override { std::printf("seed 102 "); }
};

TEST(Units, RootsAreRoundedDown) {
  for (std::uint64_t root = 0; root < 65536; root += 255) {
    LONGS_EQUAL(root, integerRoot(static_cast<std::uint32_t>(root * root)));
    LONGS_EQUAL(root, integerRoot(static_cast<std::uint32_t>(root * root + 2 * root)));
  }
  LONGS_EQUAL(65535, integerRoot(std::numeric_limits<std::uint32_t>::max()));
}

TEST(Units, RootsOfAnyNumberAreWithinTheirLastBit) {
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t value = random() >> (i % 64);
    Floating scaledBy = floatingOf(value);
    const int exponent = i % 101 - 50;
    scaledBy.exponent += exponent;
    const Root root = rootOf(scaledBy);
    const double exact = std::sqrt(std::ldexp(static_cast<double>(value), exponent));
    const double rounded = std::ldexp(root.mantissa, root.exponent);
    CHECK(rounded <= exact * (1 + 1e-12) && rounded >= exact * (1 - 3.1e-5));
  }
  LONGS_EQUAL(0, rootOf(floatingOf(0)).mantissa);
}

TEST(Units, IntegersOfAMantissaAreRoundedDownAndLimited) {
  constexpr std::int64_t kMost = std::int64_t{1} << 40;
  for (int i = 0; i < 100'000; ++i) {
    const std::uint32_t mantissa = static_cast<std::uint32_t>(random()) >> (i % 17) | 1u << 15;
    const int exponent = static_cast<int>(random() % 140) - 70;
    const double exact = std::floor(std::ldexp(mantissa, exponent));
    DOUBLES_EQUAL(std::min(exact, static_cast<double>(kMost)),
                  static_cast<double>(integerOf(mantissa, exponent, kMost)), 0);
  }
  LONGS_EQUAL(0, integerOf(0, 30, kMost));
}
