#include "host/live/fleet.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using namespace strainfinger;
using namespace strainfinger::live;

TEST_GROUP(Fleet) {
  Fleet fleet_{"can0", config::FingerConfig{}};
  std::int64_t now_us_ = 1'000'000;

  void take(const CanFrame& frame) { fleet_.take(now_us_, frame); }
  void heartbeat(std::uint8_t node = 1, std::uint8_t protocol = kProtocolVersion) {
    take(encode(HeartbeatFrame{.state = FingerState::kRun, .protocol = protocol}, node));
  }
  void touch(std::int16_t normal_mN, std::uint8_t sequence = 0, FingerFlags flags = {FingerFlag::kContact}) {
    take(encode(ContactFrame{.angle_cdeg = 9000, .flags = flags, .sequence = sequence}, 1));
    take(encode(
        ForceFrame{.normal_mN = normal_mN, .tangential_mN = -50, .flags = flags, .sequence = sequence}, 1));
    take(encode(PatchFrame{.width_um = 2000, .contacts = 1, .flags = flags, .sequence = sequence}, 1));
  }
  /// All pages of a set whose 16 gauges read the same.
  void rawSet(RawKind kind, std::uint16_t code) {
    for (std::uint8_t page = 0; page < 6; ++page)
      take(encode(
          RawFrame{.page = page, .kind = kind, .sample = 7, .code_0 = code, .code_1 = code, .code_2 = code},
          1));
  }
  BusView view() { return fleet_.view(now_us_); }
  FingerView only() {
    const BusView bus = view();
    LONGS_EQUAL(1, bus.fingers.size());
    return bus.fingers.front();
  }
};

TEST(Fleet, ShowsNobodyOnASilentBus) {
  CHECK_TRUE(view().fingers.empty());
  STRCMP_EQUAL("can0", view().name.c_str());
}

TEST(Fleet, AHeartbeatMakesAFinger) {
  touch(300);
  CHECK_TRUE(view().fingers.empty());
  heartbeat();
  LONGS_EQUAL(1, only().node);
  CHECK_TRUE(only().heartbeat.state == FingerState::kRun);
  DOUBLES_EQUAL(0.3, only().touch.value().normal_n, 1e-12);
}

TEST(Fleet, TablesThatAreNotThoseOfTheConfigAreTold) {
  Fleet fleet("can0", config::FingerConfig{}, 0x01020342U);
  const auto hasOther = [&](const HeartbeatFrame& heartbeat) {
    fleet.take(now_us_, encode(heartbeat, 1));
    return fleet.view(now_us_).fingers.at(0).hasOtherTables;
  };
  CHECK_FALSE(hasOther({.table_crc = 0x42}));
  CHECK_TRUE(hasOther({.table_crc = 0x43}));
  CHECK_FALSE(hasOther({.faults = {FingerFault::kTables}, .table_crc = 0x43}));
  CHECK_FALSE(hasOther({.protocol = kProtocolVersion + 1, .table_crc = 0x43}));
}

TEST(Fleet, AnotherNodeThanTheConfigsMayHaveTablesOfItsOwn) {
  Fleet fleet("can0", config::FingerConfig{}, 0x01020342U);
  for (const std::uint8_t node : {std::uint8_t{1}, std::uint8_t{2}})
    fleet.take(now_us_, encode(HeartbeatFrame{.table_crc = 0x43}, node));
  const BusView view = fleet.view(now_us_);
  CHECK_TRUE(view.fingers.at(0).hasOtherTables);
  CHECK_FALSE(view.fingers.at(1).hasOtherTables);
}

TEST(Fleet, WithoutAConfigAnyTablesAreRight) {
  take(encode(HeartbeatFrame{.table_crc = 0x43}, 1));
  CHECK_FALSE(only().hasOtherTables);
}

TEST(Fleet, FingersStandInTheOrderOfTheirNodes) {
  for (const int node : {63, 2, 17}) heartbeat(static_cast<std::uint8_t>(node));
  const BusView bus = view();
  LONGS_EQUAL(3, bus.fingers.size());
  LONGS_EQUAL(2, bus.fingers[0].node);
  LONGS_EQUAL(17, bus.fingers[1].node);
  LONGS_EQUAL(63, bus.fingers[2].node);
}

TEST(Fleet, FramesOfOthersMakeNoFinger) {
  take({0x701, 1, {0x05}});  // a CANopen drive's heartbeat
  take({0x741, 8, {}});      // node 65
  take({0x000, 2, {1, 1}});
  CHECK_TRUE(view().fingers.empty());
  now_us_ += 100'000;
  LONGS_EQUAL(3, view().framesPerSecond);
}

TEST(Fleet, ATouchIsShown) {
  heartbeat();
  touch(282);
  const FingerView finger = only();
  CHECK_TRUE(finger.isTouched());
  DOUBLES_EQUAL(90, finger.touch->angle_deg, 1e-12);
  DOUBLES_EQUAL(-0.05, finger.touch->tangential_n, 1e-12);
  DOUBLES_EQUAL(0.002, finger.touch->width_m, 1e-12);
  DOUBLES_EQUAL(0.282, finger.strongest_n, 1e-12);
}

TEST(Fleet, ATouchIsOneSinceItsFirstFrame) {
  heartbeat();
  touch(0, 0, {});
  now_us_ = 2'000'000;
  touch(100, 1);
  now_us_ = 2'050'000;
  touch(120, 2);
  LONGS_EQUAL(2'000'000, only().since_us);
  LONGS_EQUAL(2'050'000, only().touched_us);
  now_us_ = 3'000'000;
  touch(0, 3, {});
  LONGS_EQUAL(3'000'000, only().since_us);
}

TEST(Fleet, AReleaseIsShownForEver) {
  heartbeat();
  touch(0, 1, {});
  for (int i = 0; i < 50; ++i) now_us_ += 100'000, heartbeat();
  CHECK_TRUE(only().touch.has_value());
  CHECK_FALSE(only().isTouched());
}

TEST(Fleet, ATouchThatIsNotConfirmedIsNotShownForLong) {
  heartbeat();
  touch(282);
  now_us_ += 200'000;
  CHECK_TRUE(only().isTouched());
  now_us_ += 1;
  CHECK_FALSE(only().touch.has_value());
}

TEST(Fleet, AFingerWithoutHeartbeatsIsSilentAndItsTouchIsNotShown) {
  heartbeat();
  touch(0, 1, {});
  now_us_ += 500'000;
  CHECK_FALSE(only().isSilent());
  now_us_ += 1;
  CHECK_TRUE(only().isSilent());
  LONGS_EQUAL(500'001, only().silence_us);
  CHECK_FALSE(only().touch.has_value());
  heartbeat();
  CHECK_FALSE(only().isSilent());
}

TEST(Fleet, WhatIsSaidInAnotherProtocolIsNotShown) {
  take(encode(HeartbeatFrame{.state = FingerState::kRun,
                             .protocol = kProtocolVersion + 1,
                             .faults = {FingerFault::kCan},
                             .uptime_s = 7},
              1));
  take(encode(InfoFrame{}, 1));
  take(encode(GaugesFrame{.out_of_use = 4}, 1));
  touch(282);
  const FingerView finger = only();
  CHECK_TRUE(finger.isForeign());
  CHECK_FALSE(finger.touch.has_value() || finger.info.has_value() || finger.gauges.has_value());
  CHECK_TRUE(finger.heartbeat == HeartbeatFrame{.protocol = kProtocolVersion + 1});
}

TEST(Fleet, ATapBetweenTwoViewsIsInTheirSpan) {
  heartbeat();
  touch(100, 0), touch(900, 1), touch(0, 2, {});
  const ForceSpan span = only().span;
  DOUBLES_EQUAL(0, span.leastNormal_n, 0);
  DOUBLES_EQUAL(0.9, span.mostNormal_n, 1e-12);
  DOUBLES_EQUAL(-0.05, span.leastTangential_n, 1e-12);
  CHECK_TRUE(std::isnan(only().span.mostNormal_n));  // none since
}

TEST(Fleet, AForceThatIsNotKnownWidensNothing) {
  heartbeat();
  touch(100, 0), touch(kNotKnown<std::int16_t>, 1);
  const FingerView finger = only();
  DOUBLES_EQUAL(0.1, finger.span.leastNormal_n, 1e-12);
  DOUBLES_EQUAL(0.1, finger.strongest_n, 1e-12);
}

TEST(Fleet, ContactsASecondAreCounted) {
  heartbeat();
  for (int i = 0; i < 1000; ++i, now_us_ += 2'000) touch(100, static_cast<std::uint8_t>(i));
  LONGS_EQUAL(500, only().contactsPerSecond);
  LONGS_EQUAL(3000, only().received);
  LONGS_EQUAL(0, only().lost);
}

TEST(Fleet, LostFramesAreCounted) {
  heartbeat();
  touch(100, 0), touch(100, 3);
  LONGS_EQUAL(6, only().lost);
}

TEST(Fleet, TwoFingersOfOneNumberAreNoticed) {
  heartbeat();
  CHECK_FALSE(only().hasTwin);
  for (int i = 0; i < 40; ++i, now_us_ += 2'000)
    touch(100, static_cast<std::uint8_t>(i)), touch(100, static_cast<std::uint8_t>(i + 100));
  CHECK_TRUE(only().hasTwin);
  STRCMP_EQUAL("can0", only().bus.c_str());
}

TEST(Fleet, ATwinThatWentIsForgotten) {
  heartbeat();
  for (int i = 0; i < 40; ++i, now_us_ += 2'000)
    touch(100, static_cast<std::uint8_t>(i)), touch(100, static_cast<std::uint8_t>(i + 100));
  CHECK_TRUE(fleet_.hasTwin(1, now_us_ + 2'000'000));
  for (int i = 40; i < 80; ++i, now_us_ += 100'000) touch(100, static_cast<std::uint8_t>(i));
  CHECK_FALSE(only().hasTwin);
  CHECK_FALSE(fleet_.hasTwin(1, now_us_));
  touch(200, 79);  // one sign alone, by chance
  CHECK_FALSE(only().hasTwin);
}

TEST(Fleet, ATwinThatStaysUntouchedIsNotForgotten) {
  for (std::uint16_t i = 0; i < 100; ++i, now_us_ += 50'000)  // the other started a second later
    take(encode(HeartbeatFrame{.uptime_s = static_cast<std::uint16_t>(10 + i / 20 - i % 2)}, 1));
  CHECK_TRUE(only().hasTwin);
  CHECK_TRUE(fleet_.hasTwin(1, now_us_));
}

TEST(Fleet, TheLoadIsThatOfTheBusDocument) {
  // BUS_LOAD.md: 1512 frames of 8 bytes a second are 16.8 % of 1 Mbit/s without stuff bits.
  for (int i = 0; i < 1512; ++i) fleet_.take(1'000'000 + i * 1'000'000 / 1512, {0x181, 8, {}});
  now_us_ = 2'000'000;
  LONGS_EQUAL(1512, view().framesPerSecond);
  DOUBLES_EQUAL(0.168, view().load, 0.0005);
}

TEST(Fleet, FramesOfOtherFormatsAreInTheLoad) {
  fleet_.takeOther(now_us_, {.frame = {.extended = true, .length = 8}});
  fleet_.takeOther(now_us_, {.isRemote = true, .frame = {.length = 8}});
  now_us_ += 500'000;
  LONGS_EQUAL(2, view().framesPerSecond);
  DOUBLES_EQUAL(178e-6, view().load, 1e-12);  // of 131 and 47 bits, at 1 Mbit/s
}

TEST(Fleet, JitterIsTheWorstOfTheLastTenIntervals) {
  heartbeat();
  CHECK_TRUE(std::isnan(only().jitter_s));
  for (const int interval_us : {104'000, 99'000, 100'000}) now_us_ += interval_us, heartbeat();
  DOUBLES_EQUAL(0.004, only().jitter_s, 1e-12);
  for (int i = 0; i < 10; ++i) now_us_ += 100'000, heartbeat();
  DOUBLES_EQUAL(0, only().jitter_s, 1e-12);
}

TEST(Fleet, GaugesAndInfoAreThoseLastSaid) {
  heartbeat();
  CHECK_FALSE(only().info || only().gauges);
  take(encode(InfoFrame{.version_minor = 1, .board = 0x5C}, 1));
  take(encode(GaugesFrame{.out_of_use = 0x20, .zero_age_s = 61}, 1));
  LONGS_EQUAL(0x5C, only().info.value().board);
  LONGS_EQUAL(0x20, only().gauges.value().out_of_use);
}

TEST(Fleet, StrainsAreCodesLessTheirZeros) {
  heartbeat();
  rawSet(RawKind::kReadings, 1000);
  CHECK_TRUE(only().strains.empty());  // before the zeros are known
  rawSet(RawKind::kZeros, 900);
  rawSet(RawKind::kReadings, 1000);
  const FingerView finger = only();
  LONGS_EQUAL(16, finger.strains.size());
  for (const double strain : finger.strains) DOUBLES_EQUAL(100 * 0.03 / 32768, strain, 1e-12);
}

TEST(Fleet, StrainsThatNoMoreComeOfAreNotShown) {
  heartbeat();
  rawSet(RawKind::kZeros, 900), rawSet(RawKind::kReadings, 1000);
  now_us_ += 1'500'000;
  LONGS_EQUAL(16, only().strains.size());
  now_us_ += 1;
  CHECK_TRUE(only().strains.empty());
}

// Of six frames of 111 bits, at 1 Mbit/s.
TEST(Fleet, TellsHowMuchOfTheBusRawTakes) {
  heartbeat();
  DOUBLES_EQUAL(0, only().rawLoad, 0);
  rawSet(RawKind::kReadings, 1000);
  now_us_ += 500'000;
  DOUBLES_EQUAL(666e-6, only().rawLoad, 1e-12);
  now_us_ += 1'000'000;
  DOUBLES_EQUAL(0, only().rawLoad, 0);
}

TEST(Fleet, ATimeThatGoesBackIsTakenForTheLast) {
  heartbeat();
  fleet_.take(0, encode(HeartbeatFrame{}, 1));
  LONGS_EQUAL(0, only().silence_us);
  DOUBLES_EQUAL(0.1, only().jitter_s, 1e-12);
}
