#include "host/live/rate_meter.hpp"

#include <CppUTest/TestHarness.h>

using strainfinger::live::RateMeter;

TEST_GROUP(RateMeter) {
  RateMeter meter_;

  /// One every `period_us`, in [from, to).
  void beat(std::int64_t from_us, std::int64_t to_us, std::int64_t period_us) {
    for (std::int64_t time_us = from_us; time_us < to_us; time_us += period_us) meter_.add(time_us);
  }
};

TEST(RateMeter, IsZeroAtFirst) { LONGS_EQUAL(0, meter_.perSecond(5'000'000)); }

TEST(RateMeter, ASteadyRateIsTold) {
  beat(0, 3'000'000, 2'000);
  LONGS_EQUAL(500, meter_.perSecond(3'000'000));
}

TEST(RateMeter, WhatComesInThePresentTenthDoesNotCountYet) {
  beat(0, 3'050'000, 2'000);
  LONGS_EQUAL(500, meter_.perSecond(3'050'000));
}

TEST(RateMeter, ItDecaysTenthByTenthWhenNothingComes) {
  beat(0, 2'000'000, 2'000);
  LONGS_EQUAL(450, meter_.perSecond(2'100'000));
  LONGS_EQUAL(50, meter_.perSecond(2'900'000));
  LONGS_EQUAL(0, meter_.perSecond(3'000'000));
}

TEST(RateMeter, ALongSilenceLeavesNothing) {
  beat(0, 1'000'000, 1'000);
  LONGS_EQUAL(0, meter_.perSecond(1'000'000'000'000));
  meter_.add(1'000'000'000'000);
  LONGS_EQUAL(1, meter_.perSecond(1'000'000'100'000));
}

TEST(RateMeter, AmountsAddUp) {
  meter_.add(0, 111);
  meter_.add(50'000, 79);
  LONGS_EQUAL(190, meter_.perSecond(100'000));
}

TEST(RateMeter, TimesMayBeginAnywhere) {
  constexpr std::int64_t kNow_us = 1'800'000'000'000'000;  // microseconds since 1970
  beat(kNow_us, kNow_us + 1'000'000, 10'000);
  LONGS_EQUAL(100, meter_.perSecond(kNow_us + 1'000'000));
}
