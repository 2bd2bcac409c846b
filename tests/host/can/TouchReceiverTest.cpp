#include "host/can/touch_receiver.hpp"

#include <cmath>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::can;

// Bytes of BUS.md's example: 10.00 deg +- 2.90, quality 97; 0.290 N and -0.226 N, +- 3.5 and 4.5 mN.
TEST_GROUP(TouchReceiver) {
  TouchReceiver receiver{5};
  const CanFrame contact{0x185, 8, {0xE8, 0x03, 0x22, 0x01, 0x80, 0x81, 0x61, 0xA3}};
  const CanFrame force{0x285, 8, {0x22, 0x01, 0x1E, 0xFF, 0x07, 0x09, 0x81, 0xA3}};

  bool takes(const CanFrame& frame) { return receiver.take(frame).has_value(); }
};

TEST(TouchReceiver, GivesBothFramesInPhysicalUnits) {
  CHECK_FALSE(takes(contact));
  const auto report = receiver.take(force);
  CHECK_TRUE(report.has_value());
  DOUBLES_EQUAL(10, report->angle_deg, 1e-12);
  DOUBLES_EQUAL(2.9, report->sigmaAngle_deg, 1e-12);
  DOUBLES_EQUAL(0.29, report->normal_n, 1e-12);
  DOUBLES_EQUAL(-0.226, report->tangential_n, 1e-12);
  DOUBLES_EQUAL(0.0035, report->sigmaNormal_n, 1e-12);
  DOUBLES_EQUAL(0.0045, report->sigmaTangential_n, 1e-12);
  DOUBLES_EQUAL(97, report->quality_percent, 0);
  CHECK_TRUE(report->flags == (FingerFlags{FingerFlag::kContact, FingerFlag::kSimulated}));
  LONGS_EQUAL(0xA3, report->sequence);
}

TEST(TouchReceiver, WhatTheFingerDoesNotKnowIsUnknown) {
  takes({0x185, 8, {0xFF, 0xFF, 0xFF, 0xFF, 0x80, 0x80, 0xFF, 0x01}});
  const auto report = receiver.take({0x285, 8, {0x00, 0x80, 0x00, 0x80, 0xFF, 0xFF, 0x80, 0x01}});
  CHECK_TRUE(report.has_value());
  for (const double value :
       {report->angle_deg, report->sigmaAngle_deg, report->normal_n, report->tangential_n,
        report->sigmaNormal_n, report->sigmaTangential_n, report->quality_percent})
    CHECK_TRUE(std::isnan(value));
}

TEST(TouchReceiver, AForceOfAnotherNumberBelongsToNoContact) {
  CanFrame other = force;
  other.data[7] = 0xA4;
  takes(contact);
  CHECK_FALSE(takes(other));
  CHECK_FALSE(takes(force));
}

TEST(TouchReceiver, AForceWithoutContactGivesNothingNorDoesASecondOne) {
  CHECK_FALSE(takes(force));
  takes(contact);
  CHECK_TRUE(takes(force));
  CHECK_FALSE(takes(force));
}

TEST(TouchReceiver, OtherFramesInBetweenDoNotMatter) {
  takes(contact);
  CHECK_FALSE(takes({0x705, 8, {}}));
  CHECK_FALSE(takes({0x184, 8, {}}));
  CHECK_FALSE(takes({0x284, 8, {}}));
  CHECK_TRUE(takes(force));
}

TEST(TouchReceiver, FramesOfAnotherLengthAreNone) {
  CanFrame shorter = contact;
  shorter.length = 7;
  takes(shorter);
  CHECK_FALSE(takes(force));
}
