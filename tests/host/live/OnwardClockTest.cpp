#include "host/live/onward_clock.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger::live;

TEST_GROUP(OnwardClock) {
  OnwardClock clock_;
};

TEST(OnwardClock, GoesWithAClockThatIsNotSet) {
  for (const int time_us : {-5, 0, 7, 9'000'000}) LONGS_EQUAL(time_us, clock_.at(time_us));
}

TEST(OnwardClock, DisorderIsNoStep) {
  clock_.at(1'000'000);
  LONGS_EQUAL(1'000'000, clock_.at(500'000));
  LONGS_EQUAL(1'000'001, clock_.at(1'000'001));
}

TEST(OnwardClock, GoesOnWhenTheClockIsSetBack) {
  clock_.at(60'000'000);
  LONGS_EQUAL(60'000'000, clock_.at(0));
  LONGS_EQUAL(60'100'000, clock_.at(100'000));
  LONGS_EQUAL(61'000'000, clock_.at(1'000'000));
}

TEST(OnwardClock, GoesOnWhenItIsSetBackTwice) {
  clock_.at(60'000'000);
  clock_.at(30'000'000);
  LONGS_EQUAL(60'000'000, clock_.at(10'000'000));
  LONGS_EQUAL(60'100'000, clock_.at(10'100'000));
}

TEST(OnwardClock, GoesWithAClockThatIsSetRightAgain) {
  clock_.at(60'000'000);
  clock_.at(0);
  LONGS_EQUAL(60'500'000, clock_.at(500'000));
  LONGS_EQUAL(61'000'000, clock_.at(61'000'000));
  LONGS_EQUAL(61'100'000, clock_.at(61'100'000));
}

TEST(OnwardClock, AFrameStampedBeforeTheStepIsNotOfTheFuture) {
  clock_.at(60'000'000);
  clock_.at(0);
  LONGS_EQUAL(60'000'010, clock_.at(60'000'010));
  LONGS_EQUAL(60'000'010, clock_.at(1'000));
  LONGS_EQUAL(60'001'010, clock_.at(2'000));
}
