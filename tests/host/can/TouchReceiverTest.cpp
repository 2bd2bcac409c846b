#include "host/can/touch_receiver.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::can;

// Bytes of the examples of BUS_TOUCHES.md and BUS_SECOND_CONTACT.md: 10.00 deg +- 2.90, quality 97; 0.290 N
// and -0.226 N, +- 3.5 and 4.5 mN; 2.040 mm wide +- 0.150, chi 17/16; the second contact at 199.80 deg +-
// 3.10, quality 95, with 0.410 N and 0.035 N, +- 4.5 mN.
TEST_GROUP(TouchReceiver) {
  TouchReceiver receiver{5};
  const CanFrame contact{0x185, 8, {0xE8, 0x03, 0x22, 0x01, 0x80, 0x81, 0x61, 0xA3}};
  const CanFrame force{0x285, 8, {0x22, 0x01, 0x1E, 0xFF, 0x07, 0x09, 0x81, 0xA3}};
  const CanFrame patch{0x385, 8, {0xF8, 0x07, 0x96, 0x00, 0x11, 0x01, 0x81, 0xA3}};
  const CanFrame patchOfTwo{0x385, 8, {0xF8, 0x07, 0x96, 0x00, 0x11, 0x02, 0x81, 0xA3}};
  const CanFrame contact2{0x205, 8, {0x0C, 0x4E, 0x36, 0x01, 0x80, 0x81, 0x5F, 0xA3}};
  const CanFrame force2{0x305, 8, {0x9A, 0x01, 0x23, 0x00, 0x09, 0x09, 0x81, 0xA3}};

  bool takes(const CanFrame& frame) { return receiver.take(frame).has_value(); }
};

TEST(TouchReceiver, GivesAllFramesInPhysicalUnits) {
  CHECK_FALSE(takes(contact));
  CHECK_FALSE(takes(force));
  const auto report = receiver.take(patch);
  CHECK_TRUE(report.has_value());
  DOUBLES_EQUAL(10, report->angle_deg, 1e-12);
  DOUBLES_EQUAL(2.9, report->sigmaAngle_deg, 1e-12);
  DOUBLES_EQUAL(0.29, report->normal_n, 1e-12);
  DOUBLES_EQUAL(-0.226, report->tangential_n, 1e-12);
  DOUBLES_EQUAL(0.0035, report->sigmaNormal_n, 1e-12);
  DOUBLES_EQUAL(0.0045, report->sigmaTangential_n, 1e-12);
  DOUBLES_EQUAL(97, report->quality_percent, 0);
  DOUBLES_EQUAL(0.00204, report->width_m, 1e-15);
  DOUBLES_EQUAL(0.00015, report->sigmaWidth_m, 1e-15);
  DOUBLES_EQUAL(1.0625, report->chi, 0);
  CHECK_FALSE(report->second.has_value());
  CHECK_TRUE(report->flags == (FingerFlags{FingerFlag::kContact, FingerFlag::kSimulated}));
  LONGS_EQUAL(0xA3, report->sequence);
  CHECK_TRUE(std::isnan(report->alternative_deg));
}

// BUS_TOUCHES.md: 0..65534 and 0..254 "or more".
TEST(TouchReceiver, TheLargestValuesAreAsAReportHasThem) {
  receiver.take({0x185, 8, {0xE8, 0x03, 0xFE, 0xFF, 0x80, 0x81, 0x61, 0xA3}});
  receiver.take({0x285, 8, {0x22, 0x01, 0x1E, 0xFF, 0xFE, 0xFE, 0x81, 0xA3}});
  const auto report = receiver.take({0x385, 8, {0xFE, 0xFF, 0xFE, 0xFF, 0xFE, 0x01, 0x81, 0xA3}});
  CHECK_TRUE(report.has_value());
  const LargestValues& largest = largestValues();
  DOUBLES_EQUAL(655.34, largest.sigmaAngle_deg, 0);
  DOUBLES_EQUAL(0.127, largest.sigmaNormal_n, 0);
  DOUBLES_EQUAL(report->sigmaAngle_deg, largest.sigmaAngle_deg, 0);
  DOUBLES_EQUAL(report->sigmaNormal_n, largest.sigmaNormal_n, 0);
  DOUBLES_EQUAL(report->sigmaTangential_n, largest.sigmaTangential_n, 0);
  DOUBLES_EQUAL(report->width_m, largest.width_m, 0);
  DOUBLES_EQUAL(report->sigmaWidth_m, largest.sigmaWidth_m, 0);
  DOUBLES_EQUAL(report->chi, largest.chi, 0);
}

TEST(TouchReceiver, AnotherAngleThatFitsIsToldRelativeToTheFirst) {
  CanFrame ambiguous = contact;
  ambiguous.data[4] = 0xE9;  // -23
  takes(ambiguous), takes(force);
  DOUBLES_EQUAL(-23, receiver.take(patch)->alternative_deg, 0);
}

TEST(TouchReceiver, WhatTheFingerDoesNotKnowIsUnknown) {
  takes({0x185, 8, {0xFF, 0xFF, 0xFF, 0xFF, 0x80, 0x80, 0xFF, 0x01}});
  takes({0x285, 8, {0x00, 0x80, 0x00, 0x80, 0xFF, 0xFF, 0x80, 0x01}});
  const auto report = receiver.take({0x385, 8, {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x00, 0x80, 0x01}});
  CHECK_TRUE(report.has_value());
  for (const double value : {report->angle_deg, report->sigmaAngle_deg, report->normal_n,
                             report->tangential_n, report->sigmaNormal_n, report->sigmaTangential_n,
                             report->quality_percent, report->width_m, report->sigmaWidth_m, report->chi})
    CHECK_TRUE(std::isnan(value));
}

TEST(TouchReceiver, ASecondContactIsWaitedFor) {
  for (const CanFrame& frame : {contact, force, patchOfTwo, contact2}) CHECK_FALSE(takes(frame));
  const auto report = receiver.take(force2);
  CHECK_TRUE(report.has_value() && report->second.has_value());
  DOUBLES_EQUAL(10, report->angle_deg, 1e-12);
  DOUBLES_EQUAL(199.8, report->second->angle_deg, 1e-12);
  DOUBLES_EQUAL(3.1, report->second->sigmaAngle_deg, 1e-12);
  DOUBLES_EQUAL(95, report->second->quality_percent, 0);
  DOUBLES_EQUAL(0.41, report->second->normal_n, 1e-12);
  DOUBLES_EQUAL(0.035, report->second->tangential_n, 1e-12);
  DOUBLES_EQUAL(0.0045, report->second->sigmaNormal_n, 1e-12);
  DOUBLES_EQUAL(0.0045, report->second->sigmaTangential_n, 1e-12);
}

// BUS_SECOND_CONTACT.md: one more CONTACT2 and FORCE2 without a place and with zero force.
TEST(TouchReceiver, TheEndOfASecondContactIsWaitedForAndNoContact) {
  for (const CanFrame& frame : {contact, force, patchOfTwo, contact2}) CHECK_FALSE(takes(frame));
  CHECK_TRUE(takes(force2));
  for (const CanFrame& frame : {contact, force, patch}) CHECK_FALSE(takes(frame));
  CHECK_FALSE(takes({0x205, 8, {0xFF, 0xFF, 0xFF, 0xFF, 0x80, 0x80, 0xFF, 0xA3}}));
  const auto report = receiver.take({0x305, 8, {0x00, 0x00, 0x00, 0x00, 0xFF, 0xFF, 0x80, 0xA3}});
  CHECK_TRUE(report.has_value());
  CHECK_FALSE(report->second.has_value());
  DOUBLES_EQUAL(0, report->secondsEnd->normal_n, 0);
  DOUBLES_EQUAL(0, report->secondsEnd->tangential_n, 0);
  CHECK_TRUE(std::isnan(report->secondsEnd->angle_deg));
  CHECK_FALSE(takes(contact) || takes(force));
  CHECK_TRUE(takes(patch));
}

TEST(TouchReceiver, ASecondContactWhoseEndIsLostHoldsUpOneTouch) {
  for (const CanFrame& frame : {contact, force, patchOfTwo, contact, force, patch}) CHECK_FALSE(takes(frame));
  CHECK_FALSE(takes(contact) || takes(force));
  CHECK_TRUE(takes(patch));
}

TEST(TouchReceiver, WhatFollowsAContactMayComeInAnyOrder) {
  std::array<const CanFrame*, 4> others{&force, &patchOfTwo, &contact2, &force2};
  std::sort(others.begin(), others.end());
  int orders = 0;
  do {
    takes(contact);
    for (std::size_t i = 0; i < others.size(); ++i) CHECK_EQUAL(i == 3, takes(*others[i]));
    ++orders;
  } while (std::next_permutation(others.begin(), others.end()));
  LONGS_EQUAL(24, orders);
}

TEST(TouchReceiver, ATouchThatLostAFrameGivesNothing) {
  const std::array<CanFrame, 5> touch{contact, force, patchOfTwo, contact2, force2};
  for (std::size_t lost = 0; lost < touch.size(); ++lost) {
    for (std::size_t i = 0; i < touch.size(); ++i)
      if (i != lost) CHECK_FALSE(takes(touch[i]));
    takes({0x185, 8, {}});  // the next touch
  }
}

TEST(TouchReceiver, FramesOfAnotherNumberAreLeftOut) {
  takes(contact);
  for (CanFrame late : {force, patch}) {
    late.data[7] = 0xA2;
    CHECK_FALSE(takes(late));
  }
  CHECK_FALSE(takes(force));
  CHECK_TRUE(takes(patch));
}

TEST(TouchReceiver, FramesWithoutAContactGiveNothingNorDoTheyTwice) {
  CHECK_FALSE(takes(force) || takes(patch));
  takes(contact);
  CHECK_TRUE(!takes(force) && takes(patch));
  CHECK_FALSE(takes(force) || takes(patch));
}

TEST(TouchReceiver, OtherFramesInBetweenDoNotMatter) {
  takes(contact);
  CHECK_FALSE(takes({0x705, 8, {}}));
  CHECK_FALSE(takes({0x184, 8, {}}));
  CHECK_FALSE(takes({0x284, 8, {}}));
  CHECK_FALSE(takes(force));
  CHECK_FALSE(takes({0x384, 8, {}}));
  CHECK_TRUE(takes(patch));
}

TEST(TouchReceiver, FramesOfAnotherLengthAreNone) {
  for (const CanFrame* whole : {&contact, &force, &patch}) {
    for (const CanFrame* frame : {&contact, &force, &patch}) {
      CanFrame shorter = *frame;
      if (frame == whole) shorter.length = 7;
      CHECK_FALSE(takes(shorter));
    }
  }
}
