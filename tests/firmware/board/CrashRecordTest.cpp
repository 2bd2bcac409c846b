#include "firmware/app/crash_record.hpp"

#include <cstring>
#include <random>

#include <CppUTest/TestHarness.h>

#include "firmware/app/announce.hpp"
#include "tests/doubles/fake_can_port.hpp"

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP(CrashRecord) {
  using Bytes = std::array<unsigned char, sizeof(firmware::CrashRecord)>;
  firmware::CrashRecord record;

  /// As memory is after power-on.
  void fillWith(const Bytes& bytes) { std::memcpy(static_cast<void*>(&record), bytes.data(), bytes.size()); }
  void setup() override { fillWith({}); }

  void checkNothingToTell() {
    const LastRun run = record.take();
    CHECK_TRUE(run.crash == Crash::kNone);
    LONGS_EQUAL(0, run.restarts);
    LONGS_EQUAL(0, run.crash_address);
  }
};

TEST(CrashRecord, MemoryThatNobodyWroteTellsNothing) {
  checkNothingToTell();
  Bytes ones;
  ones.fill(0xFF);
  fillWith(ones);
  checkNothingToTell();
}

TEST(CrashRecord, TellsWhatWasWritten) {
  record.write(Crash::kAssertion, 0x08001234);
  const LastRun run = record.take();
  CHECK_TRUE(run.crash == Crash::kAssertion);
  LONGS_EQUAL(1, run.restarts);
  LONGS_EQUAL(0x08001234, run.crash_address);
}

TEST(CrashRecord, TellsACrashOnceAndGoesOnCounting) {
  record.write(Crash::kHang, 4);
  record.take();
  const LastRun second = record.take();
  CHECK_TRUE(second.crash == Crash::kNone);
  LONGS_EQUAL(1, second.restarts);
  record.write(Crash::kHardFault, 8);
  LONGS_EQUAL(2, record.take().restarts);
}

TEST(CrashRecord, CountsNoFurtherThanItsField) {
  for (int i = 0; i < 300; ++i) record.write(Crash::kHang, 0);
  LONGS_EQUAL(255, record.take().restarts);
}

TEST(CrashRecord, EveryFlippedBitMakesItTellNothing) {
  record.write(Crash::kStackOverflow, 0x20000000);
  Bytes whole;
  std::memcpy(whole.data(), &record, whole.size());
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    Bytes flipped = whole;
    flipped[bit / 8] = static_cast<unsigned char>(flipped[bit / 8] ^ 1u << bit % 8);
    fillWith(flipped);
    checkNothingToTell();
  }
}

TEST(CrashRecord, SaysWhyTheBoardStarted) {
  CHECK_TRUE(resetCause({}) == ResetCause::kPowerOn);
  CHECK_TRUE(resetCause({.crash = Crash::kHardFault, .restarts = 1}) == ResetCause::kSoftware);
  CHECK_TRUE(resetCause({.crash = Crash::kHang, .restarts = 1}) == ResetCause::kWatchdog);
  CHECK_TRUE(resetCause({.crash = Crash::kStarved, .restarts = 1}) == ResetCause::kWatchdog);
}

TEST_GROUP(Announcement) {
  doubles::FakeCanPort can;
  const InfoFrame info = infoFrame(ResetCause::kWatchdog, {Crash::kHang, 3, 0x08001234}, {1, 2}, 77);
};

TEST(Announcement, GoesOutAtOnceAndThenEveryPeriod) {
  constexpr std::uint32_t kStart_us = 0xFFFFFF00;  // the clock wraps meanwhile
  Announcement<InfoFrame> announcement(info, 5, kStart_us);
  for (std::uint32_t ms = 0; ms < 3500; ++ms) announcement.step(can, kStart_us + ms * 1000);
  LONGS_EQUAL(4, can.sent.size());
  CHECK_TRUE(decode<InfoFrame>(can.sent[0]) == info);
  LONGS_EQUAL(0x485, can.sent[0].id);
}

TEST(Announcement, StaysDueWhileThePortIsBusy) {
  Announcement<InfoFrame> announcement(info, 5, 0);
  can.busy = true;
  announcement.step(can, 0);
  can.busy = false;
  announcement.step(can, 1000);
  LONGS_EQUAL(1, can.sent.size());
}

TEST(Announcement, AFingerWithoutTablesSaysSo) {
  CHECK_TRUE(withoutTables().state == FingerState::kFault);
  CHECK_TRUE(withoutTables().faults.has(FingerFault::kTables));
}
