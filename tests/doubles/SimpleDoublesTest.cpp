#include "tests/doubles/fake_clock.hpp"
#include "tests/doubles/spy_watchdog.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(FakeClock) {};

TEST(FakeClock, GoesOnOnlyWhenTold) {
  doubles::FakeClock clock(5);
  LONGS_EQUAL(5, clock.now_us());
  LONGS_EQUAL(5, clock.now_us());
  clock.advance(7);
  LONGS_EQUAL(12, clock.now_us());
}

TEST(FakeClock, WrapsAtTwoToTheThirtyTwo) {
  doubles::FakeClock clock(UINT32_MAX);
  clock.advance(1);
  LONGS_EQUAL(0, clock.now_us());
}

TEST_GROUP(SpyWatchdog) {};

TEST(SpyWatchdog, CountsFeedsAndTellsTheCause) {
  doubles::SpyWatchdog watchdog(hal::ResetCause::kWatchdog);
  LONGS_EQUAL(0, watchdog.feeds());
  watchdog.feed();
  watchdog.feed();
  LONGS_EQUAL(2, watchdog.feeds());
  CHECK_TRUE(watchdog.resetCause() == hal::ResetCause::kWatchdog);
}
