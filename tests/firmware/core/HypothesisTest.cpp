#include "firmware/core/hypothesis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {
constexpr std::int32_t kMostStrain = std::numeric_limits<std::int32_t>::max();
constexpr std::int32_t kLeastStrain = std::numeric_limits<std::int32_t>::min();
}  // namespace

TEST_GROUP(ScaledReadings) {
  TableConstants constants{};
  std::vector<std::int32_t> strains = std::vector<std::int32_t>(16, 0);
  GaugeSet gauges = allGauges(16);

  ScaledReadings scaled(std::uint32_t noise_q4 = 16, int shift = -1) {
    constants.gauge_count = static_cast<decltype(constants.gauge_count)>(strains.size());
    return scaledReadings(constants, strains, gauges, noise_q4, shift);
  }
  /// Configured variance of a reading [(strain * 2^32)^2].
  void setNoise(double variance) {
    int exponent = 0;
    const double fraction = std::frexp(variance, &exponent);
    constants.noise_variance = static_cast<std::uint32_t>(std::ldexp(fraction, 24));
    constants.noise_variance_exponent = static_cast<std::int8_t>(exponent - 24);
  }
  static constexpr std::uint32_t kRounding_q4 = 4;  ///< of a reading and of its prediction
};

TEST(ScaledReadings, TheLargestHas15Bits) {
  for (int bits = 2; bits < 31; ++bits)
    for (const std::int32_t size :
         {(1 << bits) + 1, (1 << bits) + (1 << bits) / 3, (1 << bits) - 1 + (1 << bits)})
      for (const int sign : {1, -1}) {
        strains[5] = sign * size;
        const ScaledReadings readings = scaled();
        LONGS_EQUAL(std::max(bits - 14, 0), readings.shift);
        LONGS_EQUAL(sign * size >> readings.shift, readings.value[5]);
        if (bits >= 14) CHECK(std::abs(readings.value[5]) >= 1 << 14);
      }
}

TEST(ScaledReadings, TheEndsOfTheirWordAreReadings) {
  strains[0] = kLeastStrain;
  strains[1] = kMostStrain;
  const ScaledReadings readings = scaled();
  LONGS_EQUAL(16, readings.shift);
  LONGS_EQUAL(-32768, readings.value[0]);
  LONGS_EQUAL(32767, readings.value[1]);
}

TEST(ScaledReadings, NothingIsNothing) {
  const ScaledReadings readings = scaled();
  LONGS_EQUAL(0, readings.shift);
  for (std::size_t i = 0; i < strains.size(); ++i) LONGS_EQUAL(0, readings.value[i]);
  LONGS_EQUAL(kRounding_q4, readings.variances.reading_q4);
}

TEST(ScaledReadings, GaugesThatDoNotCountSaturate) {
  strains[3] = 20'000;
  strains[4] = kMostStrain;
  strains[5] = kLeastStrain;
  gauges &= ~(GaugeSet{3} << 4);
  const ScaledReadings readings = scaled();
  LONGS_EQUAL(0, readings.shift);
  LONGS_EQUAL(20'000, readings.value[3]);
  LONGS_EQUAL(32767, readings.value[4]);
  LONGS_EQUAL(-32768, readings.value[5]);
}

TEST(ScaledReadings, TheShiftIsKeptWhileTheLargestHas14Bits) {
  strains[2] = 1 << 18;
  LONGS_EQUAL(4, scaled().shift);
  strains[2] = (1 << 18) - 1;
  LONGS_EQUAL(3, scaled().shift);
  LONGS_EQUAL(4, scaled(16, 4).shift);
  strains[2] = (1 << 17) - 1;
  LONGS_EQUAL(2, scaled(16, 4).shift);
  strains[2] = 1 << 19;
  LONGS_EQUAL(5, scaled(16, 4).shift);
}

TEST(ScaledReadings, TheVarianceIsThatOfNoiseAndRounding) {
  strains[0] = 1 << 20;  // divided by 2^6
  for (const double variance : {1e6, 3e7, 5e8}) {
    setNoise(variance);
    DOUBLES_EQUAL(variance / 4096 * 16 + kRounding_q4, scaled().variances.reading_q4, 1);
    DOUBLES_EQUAL(variance / 4096 * 16 * 5 + kRounding_q4, scaled(5 * 16).variances.reading_q4, 5);
    LONGS_EQUAL(scaled().variances.reading_q4, scaled().variances.noise_q4);
    LONGS_EQUAL(scaled().variances.reading_q4, scaled().variances.largest_q4);
  }
}

TEST(ScaledReadings, TheModelErrorIsAPartOfTheLargestReading) {
  constants.model_error_q16 = 3277;  // 5 %
  strains[7] = -24'000;
  strains[8] = 12'000;
  DOUBLES_EQUAL(1200.0 * 1200 * 16, scaled().variances.largest_q4, 1200.0 * 1200 * 16 / 500);
  DOUBLES_EQUAL(75.0 * 75 * 16, scaled().variances.reading_q4, 75.0 * 75 * 16 / 200);
  LONGS_EQUAL(kRounding_q4, scaled().variances.noise_q4);
}

TEST(ScaledReadings, AGaugeIsTrustedByWhatItAndItsNeighboursRead) {
  std::mt19937 random(8);
  setNoise(2e5);  // 112 of a reading
  for (const int count : {3, 16, 32})
    for (const double error : {0.0005, 0.003, 0.05, 0.3, 0.999}) {
      constants.model_error_q16 = static_cast<std::uint16_t>(std::ldexp(error, 16));
      strains.resize(static_cast<std::size_t>(count));
      gauges = allGauges(count);
      for (std::int32_t& strain : strains)
        strain = std::uniform_int_distribution<>(-120'000, 120'000)(random) >> random() % 8;
      strains[1] = -130'000;  // divided by 4
      const ScaledReadings readings = scaled();
      const auto reads = [&](int i) {
        return std::abs(strains[static_cast<std::size_t>((i + count) % count)]);
      };
      const double least = std::hypot(std::sqrt(2e5), error * 130'000 / 16);
      for (int i = 0; i < count; ++i) {
        const double own = error * (reads(i) + (reads(i - 1) + reads(i + 1)) / 8.0);
        DOUBLES_EQUAL(least / (least + own),
                      std::ldexp(readings.weight_q14[static_cast<std::size_t>(i)], -14), 0.004);
      }
    }
}

TEST(ScaledReadings, BesideAGaugeThatDoesNotCountOneIsTrustedAsBesideTheLargestReading) {
  constants.model_error_q16 = 3277;
  strains[7] = strains[10] = 24'000;
  const Weights weight_q14 = scaled().weight_q14;
  CHECK_COMPARE(weight_q14[9], <, weight_q14[5]);
  for (const std::int32_t strain : {0, 300, kMostStrain}) {
    strains[10] = strain;
    gauges = allGauges(16) & ~(GaugeSet{1} << 10);
    LONGS_EQUAL(weight_q14[9], scaled().weight_q14[9]);
    LONGS_EQUAL(weight_q14[11], scaled().weight_q14[11]);
  }
}

TEST(ScaledReadings, WithoutModelErrorAllGaugesAreTrustedAlike) {
  setNoise(2e5);
  for (std::size_t i = 0; i < strains.size(); ++i) strains[i] = static_cast<std::int32_t>(i * i * 500);
  for (const Short weight_q14 : scaled().weight_q14) LONGS_EQUAL(1 << 14, weight_q14);
}

TEST(ScaledReadings, TheModelErrorIsNotThatOfGaugesThatDoNotCount) {
  constants.model_error_q16 = 3277;
  strains[7] = 20'000;
  gauges &= ~(GaugeSet{1} << 7);
  LONGS_EQUAL(kRounding_q4, scaled().variances.reading_q4);
}

TEST(ScaledReadings, AReadingAtARailIsPartOfTheTouch) {
  constants.gauge_count = 16;
  constants.model_error_q16 = 3277;
  strains[5] = 1 << 20;
  const ScaledReadings rail = scaledReadings(constants, strains, gauges, 16, -1, 1 << 22);
  LONGS_EQUAL(1 << (20 - rail.shift), rail.value[5]);
  strains[6] = 1 << 22;
  const ScaledReadings read = scaled();
  LONGS_EQUAL(read.shift, rail.shift);
  UNSIGNED_LONGS_EQUAL(read.variances.largest_q4, rail.variances.largest_q4);
  UNSIGNED_LONGS_EQUAL(read.variances.reading_q4, rail.variances.reading_q4);
}

TEST(ScaledReadings, VariancesSaturateForAnyConstants) {
  constants.model_error_q16 = 0xFFFF;
  for (const std::uint32_t variance : {std::uint32_t{0}, std::uint32_t{1}, kMostNoiseVariance})
    for (int exponent = kLeastNoiseExponent; exponent <= kMostNoiseExponent; ++exponent)
      for (const std::int32_t strain : {0, 1, 40'000, kMostStrain, kLeastStrain}) {
        constants.noise_variance = variance;
        constants.noise_variance_exponent = static_cast<std::int8_t>(exponent);
        strains[0] = strain;
        const ScaledReadings readings = scaled(std::numeric_limits<std::uint32_t>::max());
        const Variances& variances = readings.variances;
        CHECK(variances.largest_q4 >= variances.reading_q4 && variances.largest_q4 <= 0x7FFFFFFF);
        CHECK(variances.reading_q4 >= variances.noise_q4 && variances.noise_q4 >= kRounding_q4);
        for (const Short weight_q14 : readings.weight_q14) CHECK(weight_q14 > 0 && weight_q14 <= 1 << 14);
      }
}

TEST_GROUP(Rescaled) {};

TEST(Rescaled, LoadsKeepTheirSizeAndPlacesStay) {
  const ContactStates contacts{ContactState{123, 30'000, -9'000, 77}, ContactState{456, 300, 200, 88}};
  for (int to = 0; to <= 10; ++to) {
    const ContactStates other = rescaled(contacts, 5, to);
    for (std::size_t i = 0; i < 2; ++i) {
      DOUBLES_EQUAL(std::ldexp(contacts[i].normal, 5), std::ldexp(other[i].normal, to), std::ldexp(1, to));
      DOUBLES_EQUAL(std::ldexp(contacts[i].tangential, 5), std::ldexp(other[i].tangential, to),
                    std::ldexp(1, to));
      LONGS_EQUAL(contacts[i].angle_q32, other[i].angle_q32);
      LONGS_EQUAL(contacts[i].moment_q20, other[i].moment_q20);
    }
  }
}

TEST(Rescaled, LoadsSaturate) {
  const ContactStates other = rescaled({ContactState{0, kMostLoad, -kMostLoad, 0}}, 17, 0);
  LONGS_EQUAL(kMostLoad, other[0].normal);
  LONGS_EQUAL(-kMostLoad, other[0].tangential);
}

TEST_GROUP(Hypothesis) {};

TEST(Hypothesis, EachContactHasAPlaceTwoLoadsAndMaybeAWidth) {
  LONGS_EQUAL(3, (Hypothesis{1, false}.unknowns()));
  LONGS_EQUAL(4, (Hypothesis{1, true}.unknowns()));
  LONGS_EQUAL(6, (Hypothesis{2, false}.unknowns()));
  LONGS_EQUAL(8, (Hypothesis{2, true}.unknowns()));
}

TEST(Hypothesis, SetsOfGaugesHoldThem) {
  UNSIGNED_LONGS_EQUAL(0xFFF, allGauges(12));
  UNSIGNED_LONGS_EQUAL(0xFFFF'FFFF, allGauges(kMaxGauges));
  for (int gauge = 0; gauge < kMaxGauges; ++gauge) {
    CHECK_TRUE(contains(GaugeSet{1} << gauge, gauge));
    CHECK_FALSE(contains(~(GaugeSet{1} << gauge), gauge));
  }
}
