#include "host/simulation/simulated_clock.hpp"

#include <CppUTest/TestHarness.h>

using strainfinger::simulation::SimulatedClock;

TEST_GROUP(SimulatedClock) {
  SimulatedClock clock;
};

TEST(SimulatedClock, TimePassesWhenToldTo) {
  UNSIGNED_LONGS_EQUAL(0, clock.now_us());
  clock.advance_us(1500);
  UNSIGNED_LONGS_EQUAL(1500, clock.now_us());
}

TEST(SimulatedClock, TheReadingWrapsAndTheElapsedTimeDoesNot) {
  clock.advance_us(0x1'0000'0000 + 3);
  UNSIGNED_LONGS_EQUAL(3, clock.now_us());
  CHECK_TRUE(clock.elapsed_us() == 0x1'0000'0003);
}
