#include "host/config/bus_load.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger::config;

TEST_GROUP(BusLoad) {};

TEST(BusLoad, ContactsAreReportedInWholeHertzAndNoMoreOftenThanAskedFor) {
  LONGS_EQUAL(500, contactRate_hz({}));
  LONGS_EQUAL(249, contactRate_hz({.contact_rate_hz = 249.6}));
  LONGS_EQUAL(20, contactRate_hz({.contact_rate_hz = 20}));
}

TEST(BusLoad, OfEightBytesAndStuffBitsAtWorst) { LONGS_EQUAL(135, kWorstFrame_bits); }
