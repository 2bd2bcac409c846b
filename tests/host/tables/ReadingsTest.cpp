#include "host/tables/readings.hpp"

#include <cmath>
#include <limits>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using strainfinger::tables::readingOf;

TEST_GROUP(Readings) {
  static int reading(double strain, int gateShift = 13) {
    TableConstants constants{};
    constants.gate_shift = static_cast<std::uint8_t>(gateShift);
    return readingOf(constants, strain);
  }
};

TEST(Readings, AreRoundedToTheNearestStep) {
  LONGS_EQUAL(1 << 22, reading(0x1p-10));
  LONGS_EQUAL(1, reading(0.51 * 0x1p-32));
  LONGS_EQUAL(-1, reading(-0.51 * 0x1p-32));
  LONGS_EQUAL(0, reading(0.49 * 0x1p-32));
}

TEST(Readings, SaturateAtWhatTheGateHolds) {
  LONGS_EQUAL((1 << 28) - 1, reading(0x1p-4));
  LONGS_EQUAL((1 << 28) - 1, reading(std::numeric_limits<double>::infinity()));
  LONGS_EQUAL(-(1 << 28) + 1, reading(-1e300));
  LONGS_EQUAL((1 << 15) - 1, reading(1, 0));
  LONGS_EQUAL((1 << 30) - 1, reading(1, 15));
}

TEST(Readings, NotANumberIsNoStrain) { LONGS_EQUAL(0, reading(std::nan(""))); }
