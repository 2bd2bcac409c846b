// What a ring reads of a contact, against the model's own responses.
#include "host/tables/pressed_ring.hpp"

#include <cmath>

#include "tests/host/tables/DefaultResponse.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(PressedRing) {
  const model::ImpulseResponse response_ = tables::responseOf({});
  /// Between gauges 15 and 0 of 16, a third of a pitch from the latter.
  const tables::RingResponse ring_{response_, 16, -1.0 / 3};
};

TEST(PressedRing, ReadsTheModelsStrainsWithAPressingLoadsPeakPositive) {
  const tables::PressedRing ring = ring_.pressed(-0.7);
  for (int gauge = 0; gauge < 16; ++gauge) {
    const auto value = response_.at((gauge + 1.0 / 3) * 2 * std::numbers::pi / 16);
    DOUBLES_EQUAL(-value.normal + 0.7 * value.tangential, ring.readings[static_cast<std::size_t>(gauge)],
                  1e-15);
  }
}

TEST(PressedRing, HoopStrainsPeaksArePositiveAsWell) {
  config::FingerConfig config;
  config.gauges.component = StrainComponent::kHoop;
  const model::ImpulseResponse hoop = tables::responseOf(config);
  const tables::PressedRing ring = tables::RingResponse(hoop, 16, 0.1).pressed(0);
  LONGS_EQUAL(0, ring.deepest);
  DOUBLES_EQUAL(hoop.at(-0.1 * 2 * std::numbers::pi / 16).normal, ring.at(0), 1e-15);
}

TEST(PressedRing, CountsPairsAroundTheDeepestGaugeAcrossTheEndOfTheRing) {
  const tables::PressedRing ring = ring_.pressed(0.2);
  LONGS_EQUAL(0, ring.deepest);
  DOUBLES_EQUAL(ring.readings[15], ring.at(-1), 0);
  DOUBLES_EQUAL(ring.readings[2] - ring.readings[14], ring.differenceAt(2), 0);
  DOUBLES_EQUAL(-1.0 / 3, ring.offset_pitch(), 1e-12);
}

TEST(PressedRing, OffsetsGoTheShortWayRound) {
  const tables::PressedRing ring = tables::RingResponse(response_, 16, 15.8).pressed(0);
  LONGS_EQUAL(0, ring.deepest);
  DOUBLES_EQUAL(-0.2, ring.offset_pitch(), 1e-12);
}

TEST(PressedRing, SharesAreOfTheWholeRingsEnergy) {
  const tables::PressedRing ring = ring_.pressed(0.2);
  double energy = 0;
  for (const double reading : ring.readings) energy += reading * reading;
  DOUBLES_EQUAL(ring.readings[0] * ring.readings[0] / energy, ring.share(), 1e-12);
}

TEST(PressedRing, NothingReadHasNoShare) {
  DOUBLES_EQUAL(0, tables::PressedRing({0, {0, 0, 0, 0}, 0, 0}).share(), 0);
}
