#include "firmware/board/stm32g431/bit_timing.hpp"

#include <CppUTest/TestHarness.h>

#include "firmware/board/stm32g431/can_rates.hpp"

using namespace strainfinger::stm32g431;

TEST_GROUP(BitTiming) {
  static void isTiming(BitTiming expected, std::optional<BitTiming> actual) {
    CHECK_TRUE(actual.has_value());
    LONGS_EQUAL(expected.prescaler, actual->prescaler);
    LONGS_EQUAL(expected.segment1, actual->segment1);
    LONGS_EQUAL(expected.segment2, actual->segment2);
    LONGS_EQUAL(expected.jump, actual->jump);
  }
};

// By hand: 24 MHz / 1 Mbit/s = 24 clocks a bit; 24 / 5 = 4 after the sample point, which is at 20 / 24 = 83.3
// %.
TEST(BitTiming, OneMegabitFromTheCrystal) {
  isTiming({1, 19, 4, 4}, canTiming(ClockSource::kCrystal, 1'000'000));
  LONGS_EQUAL(833, canTiming(ClockSource::kCrystal, 1'000'000)->samplePoint_permille());
}

// By hand: clocks a bit, and the smallest prescaler that leaves at most 256 quanta before the sample point.
//   800k: 30 = 1 + 23 + 6      500k: 48 = 1 + 38 + 9     250k: 96 = 1 + 76 + 19    125k: 192 = 1 + 153 + 38
//    50k: 480 / 2 = 240 = 1 + 191 + 48   20k: 1200 / 4 = 300 = 1 + 239 + 60   10k: 2400 / 8 = 300
TEST(BitTiming, OtherRatesFromTheCrystal) {
  isTiming({1, 23, 6, 6}, canTiming(ClockSource::kCrystal, 800'000));
  isTiming({1, 38, 9, 9}, canTiming(ClockSource::kCrystal, 500'000));
  isTiming({1, 76, 19, 19}, canTiming(ClockSource::kCrystal, 250'000));
  isTiming({1, 153, 38, 38}, canTiming(ClockSource::kCrystal, 125'000));
  isTiming({2, 191, 48, 48}, canTiming(ClockSource::kCrystal, 50'000));
  isTiming({4, 239, 60, 60}, canTiming(ClockSource::kCrystal, 20'000));
  isTiming({8, 239, 60, 60}, canTiming(ClockSource::kCrystal, 10'000));
}

TEST(BitTiming, EveryRateIsExactAndSampledBetween80And87PointFivePercent) {
  for (const CanRate& rate : kCanRates) {
    LONGS_EQUAL(0, rateError_ppm(rate.timing, kCrystal_hz, rate.bitRate));
    CHECK_TRUE(rate.timing.samplePoint_permille() >= 800 && rate.timing.samplePoint_permille() <= 875);
  }
}

// By hand: 170 MHz / 1 Mbit/s = 170 quanta, 34 after the sample point; 170 MHz / 125 kbit/s = 1360 = 5 * 272.
TEST(BitTiming, FromTheInternalOscillator) {
  isTiming({1, 135, 34, 34}, canTiming(ClockSource::kInternal, 1'000'000));
  isTiming({5, 217, 54, 54}, canTiming(ClockSource::kInternal, 125'000));
}

// By hand: 170 MHz / 800 kbit/s = 212.5. 213 quanta are 170.4 MHz: 0.4 / 170.4 = 2347 ppm off.
TEST(BitTiming, ARateThatDoesNotDivideTheClockIsOff) {
  const auto timing = bitTiming(170'000'000, 800'000);
  CHECK_TRUE(timing.has_value());
  LONGS_EQUAL(213, timing->quanta());
  LONGS_EQUAL(2347, rateError_ppm(*timing, 170'000'000, 800'000));
}

// By hand: 12 quanta = 1 + 9 + 2, sampled at 83.3 %. 5 Mbit/s would need 4.8 quanta: 5 are 4 % off.
TEST(BitTiming, CanFdDataPhase) {
  isTiming({1, 9, 2, 2}, fdDataTiming(ClockSource::kCrystal));
  CHECK_TRUE(
      isInTolerance(bitTiming(kCrystal_hz, 2'000'000, kDataLimits), kCrystal_hz, 2'000'000, kCrystal_ppm));
  CHECK_FALSE(
      isInTolerance(bitTiming(kCrystal_hz, 5'000'000, kDataLimits), kCrystal_hz, 5'000'000, kCrystal_ppm));
  isTiming({1, 27, 6, 6}, bitTiming(kCore_hz, 5'000'000, kDataLimits));
}

// By hand, 24 quanta with 4 after the sample point: by jump 4 / (20 * 24) = 0.83 %, by phase 4 / (2 (13 * 24
// - 4)) = 0.649 %.
TEST(BitTiming, ToleranceIsTheSmallerOfBothBounds) {
  LONGS_EQUAL(6493, clockTolerance_ppm({1, 19, 4, 4}));
  LONGS_EQUAL(2083, clockTolerance_ppm({1, 19, 4, 1}));
}

TEST(BitTiming, WhatIsOutOfToleranceIsRefused) {
  const BitTiming timing{1, 19, 4, 4};
  CHECK_TRUE(isInTolerance(timing, 24'000'000, 1'000'000, 6493));
  CHECK_FALSE(isInTolerance(timing, 24'000'000, 1'000'000, 6494));
  CHECK_FALSE(isInTolerance(timing, 24'000'000, 1'010'000, 100));
  CHECK_FALSE(isInTolerance(BitTiming{1, 17, 6, 6}, 24'000'000, 1'000'000, 0));  // sampled at 75 %
  CHECK_FALSE(isInTolerance(BitTiming{1, 21, 2, 2}, 24'000'000, 1'000'000, 0));  // sampled at 91.7 %
  CHECK_FALSE(isInTolerance(std::nullopt, 24'000'000, 1'000'000, 0));
}

// 4 quanta are sampled at 75 % at the latest before the last; 9 at 77.8 or 88.9 %, and half of 9 is no
// number.
TEST(BitTiming, SomeClocksHaveNoTimingInTolerance) {
  CHECK_FALSE(bitTiming(4'000'000, 1'000'000).has_value());
  CHECK_FALSE(isInTolerance(bitTiming(9'000'000, 1'000'000), 9'000'000, 1'000'000, 0));
  CHECK_TRUE(isInTolerance(bitTiming(5'000'000, 1'000'000), 5'000'000, 1'000'000, 0));
}

TEST(BitTiming, AnUnknownRateHasNoTiming) {
  CHECK_FALSE(canTiming(ClockSource::kCrystal, 123'456).has_value());
  CHECK_FALSE(canTiming(ClockSource::kInternal, 0).has_value());
}

// The internal oscillator keeps 1 % from 0 to 85 degC; no timing of 1 Mbit/s allows that.
TEST(BitTiming, TheInternalOscillatorIsNotGuaranteed) {
  const auto timing = canTiming(ClockSource::kInternal, 1'000'000);
  CHECK_FALSE(isInTolerance(timing, kCore_hz, 1'000'000, kInternal_ppm));
  CHECK_TRUE(isInTolerance(timing, kCore_hz, 1'000'000, 7500));  // at 30 degC
}

// By hand: at 1 Mbit/s 34 / (2 (13 * 170 - 34)) = 7,812 ppm are allowed; 800 kbit/s is 2,347 off besides.
TEST(BitTiming, WhatTheInternalOscillatorCannotKeepIsRefused) {
  CHECK_FALSE(canTiming(ClockSource::kInternal, 800'000).has_value());
  for (const CanRate& rate : kCanRates)
    CHECK_EQUAL(rate.bitRate != 800'000, canTiming(ClockSource::kInternal, rate.bitRate).has_value());
}

// By hand: 170 MHz / 2 Mbit/s = 85 = 5 * 17, 17 = 1 + 13 + 3; 3 / (2 (13 * 17 - 3)) = 6880 ppm are allowed.
TEST(BitTiming, TheInternalOscillatorHasNoCanFdDataPhase) {
  const auto timing = bitTiming(kCore_hz, 2'000'000, kDataLimits);
  isTiming({5, 13, 3, 3}, timing);
  CHECK_FALSE(isInTolerance(timing, kCore_hz, 2'000'000, kInternalAt30degC_ppm));
  CHECK_FALSE(fdDataTiming(ClockSource::kInternal).has_value());
}
