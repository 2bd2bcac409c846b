// Tables over the bus: what the memory has after each word, whatever becomes of words, answers and the
// memory.
#include "firmware/app/table_loader.hpp"

#include <algorithm>
#include <cstring>

#include "firmware/app/whole_tables.hpp"
#include "firmware/app/without_tables.hpp"
#include "host/config/finger_config.hpp"
#include "host/tables/table_builder.hpp"
#include "tests/doubles/fake_can_port.hpp"
#include "tests/doubles/fake_clock.hpp"
#include "tests/doubles/fake_non_volatile.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;
using namespace strainfinger::doubles;

namespace {

constexpr std::size_t kTablePages = 12, kTablePage_bytes = 2048;

std::uint32_t wordOf(const TableImage& image, int index) {
  std::uint32_t word = 0;
  std::memcpy(&word, reinterpret_cast<const char*>(&image) + 4 * index, 4);
  return word;
}

const TableImage& defaultTables() {
  static const TableImage image = tables::buildTableImage(config::FingerConfig{});
  return image;
}

}  // namespace

TEST_GROUP(TableLoader) {
  FakeNonVolatile store{kTablePages, kTablePage_bytes};
  TableLoader<FakeNonVolatile> loader{store};

  void setup() override { loader.begin(); }
  void checkTakes(int index) {
    CHECK_TRUE(loader.take(static_cast<std::uint16_t>(index), wordOf(defaultTables(), index)) ==
               responseTo(Command::kWord, CommandStatus::kDone, static_cast<std::uint32_t>(index) + 1));
  }
  void checkRefuses(int index, CommandStatus status, std::uint32_t due) {
    CHECK_TRUE(loader.take(static_cast<std::uint16_t>(index), 0) == responseTo(Command::kWord, status, due));
  }
  TableImage stored() {
    TableImage image;
    CHECK_TRUE(store.read(0, std::as_writable_bytes(std::span(&image, 1))) == hal::StoreResult::kOk);
    return image;
  }
};

TEST(TableLoader, WhatItTakesIsWhatTheMemoryHas) {
  for (int index = 0; index < kTableWords; ++index) checkTakes(index);
  const TableImage image = stored();
  MEMCMP_EQUAL(&defaultTables(), &image, sizeof image);
  for (std::size_t page = 0; page < kTablePages; ++page) LONGS_EQUAL(1, store.erases(page));
  checkRefuses(0, CommandStatus::kOutOfTurn, kTableWords);
}

TEST(TableLoader, AWordWhoseAnswerWasLostMayComeAgain) {
  for (int index = 0; index < kTableWords; ++index) {
    checkTakes(index);
    checkTakes(index);
  }
  CHECK_TRUE(checkTableImage(stored()) == TableFault::kNone);
  for (std::size_t page = 0; page < kTablePages; ++page) LONGS_EQUAL(1, store.erases(page));
}

// Another host's.
TEST(TableLoader, AnotherWordInThePlaceOfOneThatItHasIsRefused) {
  checkTakes(0);
  checkTakes(1);
  CHECK_TRUE(loader.take(1, ~wordOf(defaultTables(), 1)) ==
             responseTo(Command::kWord, CommandStatus::kOutOfTurn, 2));
}

TEST(TableLoader, WordsOutOfTurnAreRefusedWithTheOneThatIsDue) {
  checkRefuses(1, CommandStatus::kOutOfTurn, 0);
  LONGS_EQUAL(0, store.erases(0));
  for (int index = 0; index < 5; ++index) checkTakes(index);
  for (const int index : {0, 3, 4, 6, 7, kTableWords - 1}) checkRefuses(index, CommandStatus::kOutOfTurn, 5);
  checkTakes(5);
}

TEST(TableLoader, NothingIsTakenBeforeItBegins) {
  TableLoader<FakeNonVolatile> closed(store);
  CHECK_TRUE(closed.take(0, 1) == responseTo(Command::kWord, CommandStatus::kOutOfTurn));
  LONGS_EQUAL(0, store.erases(0));
}

TEST(TableLoader, BegunAnewItTakesAnotherFingersFromTheFirstWordOn) {
  for (int index = 0; index < 1000; ++index) checkTakes(index);
  loader.begin();
  for (int index = 0; index < kTableWords; ++index) checkTakes(index);
  CHECK_TRUE(checkTableImage(stored()) == TableFault::kNone);
}

TEST(TableLoader, AMemoryThatFailsIsTold) {
  store.wearOut(1);
  for (int index = 0; index < 512; ++index) checkTakes(index);
  checkRefuses(512, CommandStatus::kNotKept, 512);
  LONGS_EQUAL(1, store.erases(1));
  CHECK_TRUE(loader.take(512, 0) ==
             responseTo(Command::kWord, CommandStatus::kOutOfTurn));  // it is not erased again
  LONGS_EQUAL(1, store.erases(1));
  hal::NoStore none;
  TableLoader<hal::NoStore> nowhere(none);
  nowhere.begin();
  CHECK_TRUE(nowhere.take(0, 1) == responseTo(Command::kWord, CommandStatus::kNotKept, 0));
}

TEST(TableLoader, WhereverThePowerGoesTheTablesAreTheOldTheNewOrNone) {
  config::FingerConfig another;
  another.gauges.radius_m = 9.5e-3;
  const TableImage old = tables::buildTableImage(another);
  const int steps = kTableWords / 2 + static_cast<int>(kTablePages);
  int kept = 0, refused = 0, taken = 0;
  constexpr int kEach = 300, kEvery = 97;  // of words, which are all written alike
  for (int cut = 0; cut <= steps;
       cut = cut < kEach || cut >= steps - 3 ? cut + 1 : std::min(cut + kEvery, steps - 3)) {
    FakeNonVolatile memory{kTablePages, kTablePage_bytes};
    CHECK_TRUE(memory.write(0, std::as_bytes(std::span(&old, 1))) == hal::StoreResult::kOk);
    TableLoader<FakeNonVolatile> cutShort(memory);
    cutShort.begin();
    memory.cutPowerAfter(cut);
    for (int index = 0; index < kTableWords && memory.hasPower(); ++index)
      cutShort.take(static_cast<std::uint16_t>(index), wordOf(defaultTables(), index));
    memory.restorePower();
    TableImage found;
    const bool isReadable =
        memory.read(0, std::as_writable_bytes(std::span(&found, 1))) == hal::StoreResult::kOk;
    const TableImage* const used = isReadable ? ifWhole(tablesOf(found, defaultTables())) : nullptr;
    if (used == nullptr) ++refused;
    if (used != nullptr) (used->crc32 == old.crc32 ? kept : taken) += 1;
    if (used != nullptr) CHECK_TRUE(used->crc32 == old.crc32 || cut >= steps);
  }
  LONGS_EQUAL(0, kept);  // the first step erases
  LONGS_EQUAL(1, taken);
  CHECK_TRUE(refused > 300);
}

TEST(TableLoader, TablesOfMoreGaugesThanABoardHasAreNotUsed) {
  POINTERS_EQUAL(&defaultTables(), ifWhole(defaultTables(), 16));
  POINTERS_EQUAL(nullptr, ifWhole(defaultTables(), 15));
}

TEST_GROUP(WithoutTables) {
  static constexpr std::uint8_t kNode = 5;
  static constexpr std::uint32_t kUptime_s = 500;
  FakeNonVolatile store{kTablePages, kTablePage_bytes};
  FakeCanPort can;
  FakeClock clock{1'000'000};
  WithoutTables<FakeCanPort, FakeNonVolatile> finger{
      {kNode, true, EraseBudget(1), kUptime_s}, can, store, clock.now_us()};

  void step(std::uint32_t time_us = 1) {
    clock.advance(time_us);
    finger.step(clock.now_us());
  }
  void checkAnswered(const RequestFrame& request, const ResponseFrame& response) {
    can.sent.clear();
    can.deliver(encode(request, kNode));
    step();
    LONGS_EQUAL(1, can.sent.size());
    CHECK_TRUE(can.sent[0] == encode(response, kNode));
  }
};

TEST(WithoutTables, ItSaysSoTenTimesASecond) {
  for (int i = 0; i < 1000; ++i) step(1000);
  LONGS_EQUAL(10, can.sent.size());
  for (const CanFrame& frame : can.sent) {
    const auto heartbeat = decode<HeartbeatFrame>(frame);
    CHECK_TRUE(heartbeat && heartbeat->state == FingerState::kFault);
    CHECK_TRUE(heartbeat->faults.has(FingerFault::kTables));
  }
}

TEST(WithoutTables, ItTakesTablesAndStartsAnewWithThem) {
  step();
  checkAnswered(loadRequest(), responseTo(Command::kLoad, CommandStatus::kDone));
  for (std::uint16_t index = 0; index < kTableWords; ++index)
    checkAnswered(wordRequest(index, wordOf(defaultTables(), index)),
                  responseTo(Command::kWord, CommandStatus::kDone, index + 1u));
  CHECK_FALSE(finger.isLeaving());
  checkAnswered(restartRequest(), responseTo(Command::kRestart, CommandStatus::kDone));
  CHECK_TRUE(finger.isLeaving());
  TableImage image;
  CHECK_TRUE(store.read(0, std::as_writable_bytes(std::span(&image, 1))) == hal::StoreResult::kOk);
  LONGS_EQUAL(defaultTables().crc32, image.crc32);
  CHECK_TRUE(checkTableImage(image) == TableFault::kNone);
}

// A program that died after its `load`: the tables are still whole.
TEST(WithoutTables, ItStartsAnewByItselfIfNoWordFollowsTheLoad) {
  for (int half_s = 1; half_s < 60; ++half_s) step(500'000);
  CHECK_FALSE(finger.isLeaving());
  step(1'000'000);
  CHECK_TRUE(finger.isLeaving());
}

TEST(WithoutTables, AWordInTheLastMomentKeepsIt) {
  for (int half_s = 1; half_s < 60; ++half_s) step(500'000);
  can.deliver(encode(wordRequest(0, 7), kNode));
  step(500'000);
  CHECK_TRUE(can.sent.back() == encode(responseTo(Command::kWord, CommandStatus::kDone, 1), kNode));
  CHECK_FALSE(finger.isLeaving());
}

TEST(WithoutTables, AnotherLoadIsWaitedForAsLong) {
  for (int second = 0; second < 29; ++second) step(1'000'000);
  checkAnswered(loadRequest(), responseTo(Command::kLoad, CommandStatus::kDone));
  for (int second = 0; second < 29; ++second) step(1'000'000);
  CHECK_FALSE(finger.isLeaving());
  step(1'000'000);
  step(1'000'000);
  CHECK_TRUE(finger.isLeaving());
}

TEST(WithoutTables, AfterAWordItWaitsForTheOthers) {
  step();
  checkAnswered(wordRequest(0, 7), responseTo(Command::kWord, CommandStatus::kDone, 1));
  for (int second = 0; second < 100; ++second) step(1'000'000);
  checkAnswered(loadRequest(), responseTo(Command::kLoad, CommandStatus::kDone));
  for (int second = 0; second < 100; ++second) step(1'000'000);
  CHECK_FALSE(finger.isLeaving());
}

TEST(WithoutTables, AFingerThatHadNoneWaitsForThem) {
  WithoutTables<FakeCanPort, FakeNonVolatile> started({kNode, false, EraseBudget(), 0}, can, store,
                                                      clock.now_us());
  for (int second = 0; second < 100; ++second) {
    clock.advance(1'000'000);
    started.step(clock.now_us());
  }
  CHECK_FALSE(started.isLeaving());
}

TEST(WithoutTables, WithoutLoadNothingIsTaken) {
  WithoutTables<FakeCanPort, FakeNonVolatile> started({kNode, false, EraseBudget(), 0}, can, store,
                                                      clock.now_us());
  can.deliver(encode(wordRequest(0, 7), kNode));
  started.step(clock.now_us());
  CHECK_TRUE(can.sent.back() == encode(responseTo(Command::kWord, CommandStatus::kOutOfTurn), kNode));
}

TEST(WithoutTables, WithoutMemoryForThemItLoadsNone) {
  FakeNonVolatile small{2, kTablePage_bytes};
  WithoutTables<FakeCanPort, FakeNonVolatile> started({kNode, false, EraseBudget(), 0}, can, small,
                                                      clock.now_us());
  can.deliver(encode(loadRequest(), kNode));
  started.step(clock.now_us());
  CHECK_TRUE(can.sent.back() == encode(responseTo(Command::kLoad, CommandStatus::kNotKept), kNode));
}

// 60 s of the budget are used at 500 s of uptime: an erase a minute from there on.
TEST(WithoutTables, ItsMemoryIsNotWornOutByWhoLoadsAllTheTime) {
  step();
  for (int hour = 0; hour < 24; ++hour)
    for (int half_s = 0; half_s < 7200; ++half_s) {
      clock.advance(500'000);
      for (const RequestFrame& request : {loadRequest(), wordRequest(0, 7)}) {
        can.deliver(encode(request, kNode));
        finger.step(clock.now_us());
      }
      can.sent.clear();
    }
  CHECK_COMPARE(store.erases(0), <=, 24 * 60 + static_cast<int>(EraseBudget::kBurst) + 1);
  CHECK_COMPARE(store.erases(0), >=, 24 * 60 - 1);
}

TEST(WithoutTables, LoadBeginsAnewAsOftenAsItsBudgetAllows) {
  WithoutTables<FakeCanPort, FakeNonVolatile> soon({kNode, true, EraseBudget(1), 0}, can, store,
                                                   clock.now_us());
  const auto answer = [&](const RequestFrame& request) {
    can.deliver(encode(request, kNode));
    soon.step(clock.now_us());
    return readSingleFrame<ResponseFrame>(can.sent.back(), kNode).value();
  };
  CHECK_TRUE(answer(wordRequest(0, 7)) == responseTo(Command::kWord, CommandStatus::kDone, 1));
  CHECK_TRUE(answer(loadRequest()) == responseTo(Command::kLoad, CommandStatus::kDone));
  CHECK_TRUE(answer(wordRequest(1, 7)) == responseTo(Command::kWord, CommandStatus::kOutOfTurn, 0));
  CHECK_TRUE(answer(loadRequest()) ==
             responseTo(Command::kLoad, CommandStatus::kDone));  // said again: nothing is erased
  CHECK_TRUE(answer(wordRequest(0, 7)) == responseTo(Command::kWord, CommandStatus::kDone, 1));
  CHECK_TRUE(answer(loadRequest()) == responseTo(Command::kLoad, CommandStatus::kWait, 60));
}

TEST(WithoutTables, ItIsBusyToAllElse) {
  step();
  checkAnswered(tareRequest(false), responseTo(Command::kTare, CommandStatus::kBusy));
  checkAnswered(countRequest(Count::kErases), responseTo(Command::kCount, CommandStatus::kBusy));
  checkAnswered({.length = 1, .command = Command::kWord},
                responseTo(Command::kWord, CommandStatus::kBadArgument));
  checkAnswered({.length = 1, .command = static_cast<Command>(99)},
                responseTo(static_cast<Command>(99), CommandStatus::kUnknownCommand));
}

TEST(WithoutTables, AnAnswerWaitsForThePortAndThenIsTooOld) {
  step();
  can.sent.clear();
  can.busy = true;
  can.deliver(encode(restartRequest(), kNode));
  step();
  CHECK_FALSE(finger.isLeaving());
  can.busy = false;
  step();
  CHECK_TRUE(can.sent.back() == encode(responseTo(Command::kRestart, CommandStatus::kDone), kNode));
  CHECK_TRUE(finger.isLeaving());

  can.busy = true;
  can.deliver(encode(tareRequest(false), kNode));
  step();
  can.busy = false;
  can.sent.clear();
  step(500'000);
  for (const CanFrame& frame : can.sent)
    CHECK_FALSE(readSingleFrame<ResponseFrame>(frame, kNode).has_value());
}
