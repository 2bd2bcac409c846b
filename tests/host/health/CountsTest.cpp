#include "host/health/counts.hpp"

#include <CppUTest/TestHarness.h>

#include "tests/host/can/fake_bus_port.hpp"

using namespace strainfinger;
using namespace strainfinger::health;

TEST_GROUP(Counts) {
  static constexpr std::uint8_t kNode = 5;
  can::FakeBusPort bus;

  /// A finger that counts 100 of the first, 101 of the second .., and has not heard of those from `unknown`
  /// on.
  void answerUntil(int unknown) {
    bus.onSend = [this, unknown](const CanFrame& frame) {
      const auto request = readSingleFrame<RequestFrame>(frame, kNode);
      if (!request || request->command != Command::kCount) return;
      const bool isKnown = request->argument < unknown;
      bus.hear(responseTo(Command::kCount, isKnown ? CommandStatus::kDone : CommandStatus::kBadArgument,
                          100U + request->argument),
               kNode);
    };
  }
};

TEST(Counts, EachIsAskedForOnce) {
  answerUntil(kLastCount + 1);
  const std::vector<Counted> counts = askForCounts(bus, kNode);
  LONGS_EQUAL(kLastCount + 1, counts.size());
  LONGS_EQUAL(kLastCount + 1, bus.sent.size());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    LONGS_EQUAL(i, static_cast<int>(counts[i].count));
    CHECK_TRUE(counts[i].answer == CountAnswer::kTold);
    LONGS_EQUAL(100 + i, counts[i].value);
  }
}

TEST(Counts, WhatAnOlderFirmwareDoesNotCountIsToldApart) {
  answerUntil(2);
  const std::vector<Counted> counts = askForCounts(bus, kNode);
  LONGS_EQUAL(kLastCount + 1, counts.size());
  LONGS_EQUAL(101, counts[1].value);
  for (std::size_t i = 2; i < counts.size(); ++i) CHECK_TRUE(counts[i].answer == CountAnswer::kNotCounted);
}

TEST(Counts, WhoDoesNotAnswerIsAskedTwice) {
  const std::vector<Counted> counts = askForCounts(bus, kNode);
  LONGS_EQUAL(kLastCount + 1, counts.size());
  for (const Counted& counted : counts) CHECK_TRUE(counted.answer == CountAnswer::kSilence);
  LONGS_EQUAL(2, bus.sent.size());
}

TEST(Counts, AnAnswerThatIsLostIsAskedForAgain) {
  int asked = 0;
  bus.onSend = [&](const CanFrame&) {
    if (++asked > 1) bus.hear(responseTo(Command::kCount, CommandStatus::kDone, 7), kNode);
  };
  const std::vector<Counted> counts = askForCounts(bus, kNode);
  for (const Counted& counted : counts) CHECK_TRUE(counted.answer == CountAnswer::kTold);
  LONGS_EQUAL(kLastCount + 2, bus.sent.size());
}

// A response doesn't say which count it is of.
TEST(Counts, AnAnswerThatMayBeSomebodyElsesIsAskedForAgain) {
  int asked = 0;
  bus.onSend = [&](const CanFrame&) {
    if (++asked == 1) bus.hear(countRequest(Count::kLostSets), kNode);
    bus.hear(responseTo(Command::kCount, CommandStatus::kDone, asked == 1 ? 5000 : 7), kNode);
  };
  const std::vector<Counted> counts = askForCounts(bus, kNode);
  LONGS_EQUAL(7, counts[0].value);
  LONGS_EQUAL(kLastCount + 2, bus.sent.size());
}

TEST(Counts, WhereOthersAlwaysAskNoAnswerIsBelieved) {
  bus.onSend = [&](const CanFrame&) {
    bus.hear(countRequest(Count::kLostSets), kNode);
    bus.hear(responseTo(Command::kCount, CommandStatus::kDone, 5000), kNode);
  };
  for (const Counted& counted : askForCounts(bus, kNode))
    CHECK_TRUE(counted.answer == CountAnswer::kOthersAsk);
}

TEST(Counts, ABusThatTakesNothingIsToldApart) {
  bus.takes = false;
  for (const Counted& counted : askForCounts(bus, kNode)) CHECK_TRUE(counted.answer == CountAnswer::kNotSent);
}
