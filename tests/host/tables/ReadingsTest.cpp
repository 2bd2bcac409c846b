#include "host/tables/readings.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using strainfinger::tables::gaugesAtRail;
using strainfinger::tables::isAtRail;
using strainfinger::tables::readingOf;

TEST_GROUP(Readings){static int reading(double strain, int gateShift = 13){TableConstants constants{};
constants.gate_shift = static_cast<std::uint8_t>(gateShift);
return readingOf(constants, strain);
}
/// Of a finger with 12 bits over +-0.03.
static TableImage image() {
  TableImage image{};
  image.parameters.full_scale_strain = 0.03;
  image.constants.adc_rail = 0xFFF0;
  return image;
}
static bool atRail(double strain) { return isAtRail(image(), strain); }
}
;

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

TEST(Readings, AreAtARailWhereTheNearestCodeIsTheFirstOrTheLast) {
  constexpr double kCode = 2 * 0.03 / 4096;
  CHECK_TRUE(atRail(-0.03 + 0.49 * kCode));
  CHECK_FALSE(atRail(-0.03 + 0.51 * kCode));
  CHECK_TRUE(atRail(0.03 - 1.49 * kCode));
  CHECK_FALSE(atRail(0.03 - 1.51 * kCode));
}

TEST(Readings, BeyondFullScaleAreAtARail) {
  for (const double strain : {0.03, 0.031, 0.2, 1.0}) {
    CHECK_TRUE(atRail(strain));
    CHECK_TRUE(atRail(-strain));
  }
  CHECK_FALSE(atRail(0));
}

TEST(Readings, ARingTellsWhichOfItsGaugesAreAtARail) {
  const std::array strains{0.0, 0.03, -0.02, -0.5, 0.029};
  LONGS_EQUAL(0b01010, gaugesAtRail(image(), strains));
}
