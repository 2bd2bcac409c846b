#include "firmware/core/gauge_watch.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {
constexpr GaugeSet kFive = 1u << 5, kSix = 1u << 6;
constexpr std::uint32_t kPitch_q32 = 1u << 28;
}  // namespace

TEST_GROUP(GaugeWatch) {
  GaugeWatch watch;

  void suspectAt(GaugeSet gauge, double pitches) {
    watch.suspect(gauge, static_cast<std::uint32_t>(static_cast<std::int64_t>(pitches * kPitch_q32)));
  }
  void convictFive() {
    for (int place = 0; place < GaugeWatch::kPlaces; ++place) suspectAt(kFive, 4 + place);
    UNSIGNED_LONGS_EQUAL(kFive, watch.outOfUse());
  }
};

TEST(GaugeWatch, SuspicionsAtSeveralPlacesTakeAGaugeOutOfUse) {
  for (int place = 0; place < GaugeWatch::kPlaces; ++place) {
    UNSIGNED_LONGS_EQUAL(0, watch.outOfUse());
    suspectAt(kFive, 4 + place * 0.6);
  }
  UNSIGNED_LONGS_EQUAL(kFive, watch.outOfUse());
}

TEST(GaugeWatch, AtOnePlaceItMayBeAnythingElse) {
  for (int set = 0; set < 100'000; ++set) suspectAt(kFive, 4 + set % 5 * 0.1);
  UNSIGNED_LONGS_EQUAL(0, watch.outOfUse());
}

TEST(GaugeWatch, BackAtAPlaceItIsAnotherTouch) {
  for (const double place : {4, 5, 4}) {
    UNSIGNED_LONGS_EQUAL(0, watch.outOfUse());
    suspectAt(kFive, place);
  }
  UNSIGNED_LONGS_EQUAL(kFive, watch.outOfUse());
}

TEST(GaugeWatch, AroundZeroOnePlaceIsOne) {
  for (int set = 0; set < 100; ++set) suspectAt(kFive, set % 2 == 0 ? 0.2 : -0.2);
  UNSIGNED_LONGS_EQUAL(0, watch.outOfUse());
}

TEST(GaugeWatch, SuspicionsOfDifferentGaugesDoNotAddUp) {
  for (int gauge = 0; gauge < 16; ++gauge) suspectAt(GaugeSet{1} << gauge, gauge);
  for (int gauge = 0; gauge < 16; ++gauge) suspectAt(GaugeSet{1} << gauge, gauge + 1);
  UNSIGNED_LONGS_EQUAL(0, watch.outOfUse());
}

TEST(GaugeWatch, NoSuspicionIsNone) {
  for (int set = 0; set < 100; ++set) suspectAt(0, set);
  UNSIGNED_LONGS_EQUAL(0, watch.outOfUse());
}

TEST(GaugeWatch, ATouchThatAGaugeFeelsRightClearsIt) {
  for (int round = 0; round < 100; ++round) {
    suspectAt(kFive, round);
    suspectAt(kFive, round + 1);
    watch.vindicate(kFive, 0);
  }
  UNSIGNED_LONGS_EQUAL(0, watch.outOfUse());
}

TEST(GaugeWatch, WhatSpeaksForOthersDoesNotClearAGauge) {
  for (int place = 0; place < GaugeWatch::kPlaces; ++place) {
    suspectAt(kFive, place);
    watch.vindicate(~kFive, 0);
  }
  UNSIGNED_LONGS_EQUAL(kFive, watch.outOfUse());
}

TEST(GaugeWatch, AGaugeOutOfUseComesBackWhenItReadsRightForLong) {
  convictFive();
  for (int set = 0; set + 1 < GaugeWatch::kConvincing; ++set) watch.vindicate(kFive, 0);
  UNSIGNED_LONGS_EQUAL(kFive, watch.outOfUse());
  watch.vindicate(kFive, 0);
  UNSIGNED_LONGS_EQUAL(0, watch.outOfUse());
}

TEST(GaugeWatch, AGaugeThatIsWrongInBetweenStaysOutOfUse) {
  convictFive();
  for (int round = 0; round < 10; ++round) {
    for (int set = 0; set + 1 < GaugeWatch::kConvincing; ++set) watch.vindicate(kFive, 0);
    watch.vindicate(0, kFive);
  }
  UNSIGNED_LONGS_EQUAL(kFive, watch.outOfUse());
}

TEST(GaugeWatch, AGaugeThatCameBackHasToFailAgainAtAsManyPlaces) {
  convictFive();
  for (int set = 0; set < GaugeWatch::kConvincing; ++set) watch.vindicate(kFive, 0);
  suspectAt(kFive, 8);
  suspectAt(kFive, 9);
  UNSIGNED_LONGS_EQUAL(0, watch.outOfUse());
}

TEST(GaugeWatch, AGaugeAtARailTwiceInARowIsOutOfUse) {
  watch.implausiblyAtRail(kFive | kSix);
  UNSIGNED_LONGS_EQUAL(0, watch.outOfUse());
  watch.implausiblyAtRail(kFive);
  UNSIGNED_LONGS_EQUAL(kFive, watch.outOfUse());
}

TEST(GaugeWatch, AGaugeAtARailNowAndAgainIsNot) {
  for (int set = 0; set < 100; ++set) watch.implausiblyAtRail(set % 2 == 0 ? kFive : 0);
  UNSIGNED_LONGS_EQUAL(0, watch.outOfUse());
}

TEST(GaugeWatch, EveryGaugeOfTheLargestRingCanFail) {
  for (int gauge = 0; gauge < kMaxGauges; ++gauge) {
    watch = {};
    for (int place = 0; place < GaugeWatch::kPlaces; ++place) suspectAt(GaugeSet{1} << gauge, place);
    UNSIGNED_LONGS_EQUAL(GaugeSet{1} << gauge, watch.outOfUse());
  }
}

TEST(GaugeWatch, TwoSetsAtARailTakeAGaugeOutUntilItReadsNothing) {
  CHECK_FALSE(watch.implausiblyAtRail(kFive));
  CHECK_FALSE(watch.implausiblyAtRail(kSix));
  CHECK_TRUE(watch.implausiblyAtRail(kFive | kSix));
  UNSIGNED_LONGS_EQUAL(kSix, watch.outOfUse());
  CHECK_TRUE(watch.implausiblyAtRail(kFive | kSix));
  CHECK_FALSE(watch.implausiblyAtRail(kFive | kSix));  // is already out
  watch.noLongerAtRail(kSix);
  UNSIGNED_LONGS_EQUAL(kFive, watch.outOfUse());
  watch.noLongerAtRail(~kFive);
  UNSIGNED_LONGS_EQUAL(kFive, watch.outOfUse());
}

TEST(GaugeWatch, AGaugeThatIsOutForAnotherReasonDoesNotComeBackFromARail) {
  convictFive();
  watch.takeOut(kSix);
  for (int set = 0; set < 3; ++set) CHECK_FALSE(watch.implausiblyAtRail(kFive | kSix));
  watch.noLongerAtRail(kFive | kSix);
  UNSIGNED_LONGS_EQUAL(kFive | kSix, watch.outOfUse());
}

TEST(GaugeWatch, AGaugeThatATouchBroughtBackFromARailCanBeConvicted) {
  for (int set = 0; set < 2; ++set) watch.implausiblyAtRail(kFive);
  for (int set = 0; set < GaugeWatch::kConvincing; ++set) watch.vindicate(kFive, 0);
  UNSIGNED_LONGS_EQUAL(0, watch.outOfUse());
  convictFive();
  watch.noLongerAtRail(kFive);
  UNSIGNED_LONGS_EQUAL(kFive, watch.outOfUse());
}

TEST(GaugeWatch, WhatSpokeForAGaugeBeforeItCameBackDoesNotCountWhenItIsOutAgain) {
  for (int set = 0; set < 2; ++set) watch.implausiblyAtRail(kFive);
  for (int set = 0; set + 1 < GaugeWatch::kConvincing; ++set) watch.vindicate(kFive, 0);
  watch.noLongerAtRail(kFive);
  convictFive();
  watch.vindicate(kFive, 0);
  UNSIGNED_LONGS_EQUAL(kFive, watch.outOfUse());
}
