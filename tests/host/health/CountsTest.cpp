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
    LONGS_EQUAL(100 + i, counts[i].value.value());
  }
}

TEST(Counts, WhatAnOlderFirmwareDoesNotCountIsNotKnown) {
  answerUntil(2);
  const std::vector<Counted> counts = askForCounts(bus, kNode);
  LONGS_EQUAL(kLastCount + 1, counts.size());
  LONGS_EQUAL(101, counts[1].value.value());
  CHECK_FALSE(counts[2].value.has_value());
  CHECK_FALSE(counts[4].value.has_value());
  LONGS_EQUAL(3, bus.sent.size());
}

TEST(Counts, WhoDoesNotAnswerIsAskedOnce) {
  const std::vector<Counted> counts = askForCounts(bus, kNode);
  LONGS_EQUAL(kLastCount + 1, counts.size());
  for (const Counted& counted : counts) CHECK_FALSE(counted.value.has_value());
  LONGS_EQUAL(1, bus.sent.size());
}
