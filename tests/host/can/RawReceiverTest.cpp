#include "host/can/raw_receiver.hpp"

#include "host/base/failure.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using can::RawReceiver;
using can::RawSet;

TEST_GROUP(RawReceiver) {
  static constexpr std::uint8_t kNode = 5;
  RawReceiver receiver{kNode, 16};

  /// Gauge i of sample s has code 1000 s + i.
  static CanFrame page(int number, int sample, RawKind kind = RawKind::kReadings, std::uint8_t node = kNode) {
    const int first = 1000 * sample + 3 * number;
    RawFrame frame{static_cast<std::uint8_t>(number), kind, static_cast<std::uint8_t>(sample)};
    frame.code_0 = static_cast<std::uint16_t>(first);
    if (number < 5) frame.code_1 = static_cast<std::uint16_t>(first + 1);
    if (number < 5) frame.code_2 = static_cast<std::uint16_t>(first + 2);
    return encode(frame, node);
  }
  std::optional<RawSet> takeSet(int sample, RawKind kind = RawKind::kReadings) {
    for (int number = 0; number < 5; ++number)
      CHECK_FALSE(receiver.take(page(number, sample, kind)).has_value());
    return receiver.take(page(5, sample, kind));
  }
  template <typename Check>
  static void checkMismatch(const char* message, Check check) {
    try {
      check();
    } catch (const Failure& failure) {
      STRCMP_CONTAINS(message, failure.what());
      CHECK(failure.code() == ExitCode::kMismatch);
      return;
    }
    FAIL("accepted");
  }
};

TEST(RawReceiver, ASetIsWholeWithItsLastPage) {
  const auto set = takeSet(7);
  LONGS_EQUAL(7, set->sample);
  CHECK_FALSE(set->zeroing);
  LONGS_EQUAL(16, set->codes.size());
  for (std::size_t i = 0; i < 16; ++i) LONGS_EQUAL(7000 + i, set->codes[i]);
}

TEST(RawReceiver, SetsFollowEachOther) {
  for (int sample = 1; sample < 20; ++sample) LONGS_EQUAL(sample, takeSet(sample)->sample);
  LONGS_EQUAL(0, receiver.incomplete());
}

TEST(RawReceiver, ASetThatLostAPageGivesNothingAndIsCounted) {
  for (const int number : {0, 1, 3, 4, 5}) CHECK_FALSE(receiver.take(page(number, 1)).has_value());
  LONGS_EQUAL(1, receiver.incomplete());
  CHECK_TRUE(takeSet(2).has_value());
  LONGS_EQUAL(1, receiver.incomplete());
}

TEST(RawReceiver, ASetIsOfOneSample) {
  for (const int number : {0, 1, 2}) receiver.take(page(number, 1));
  for (const int number : {3, 4, 5}) CHECK_FALSE(receiver.take(page(number, 2)).has_value());
  LONGS_EQUAL(1, receiver.incomplete());
}

TEST(RawReceiver, SetsOfAZeroAreMarked) { CHECK_TRUE(takeSet(3, RawKind::kZeroing)->zeroing); }

TEST(RawReceiver, ZerosComeBetweenSetsAPageASample) {
  for (int sample = 0; sample < 6; ++sample) {
    CHECK_TRUE(receiver.zeros().empty());
    CHECK_TRUE(takeSet(sample).has_value());
    auto zero = decode<RawFrame>(page(sample, 33, RawKind::kZeros));
    zero->sample = static_cast<std::uint8_t>(sample);
    receiver.take(encode(*zero, kNode));
  }
  LONGS_EQUAL(16, receiver.zeros().size());
  LONGS_EQUAL(33'015, receiver.zeros()[15]);
}

TEST(RawReceiver, ZerosThatLostAPageAreNotUsed) {
  for (const int number : {0, 1, 3, 4, 5}) receiver.take(page(number, 33, RawKind::kZeros));
  CHECK_TRUE(receiver.zeros().empty());
  LONGS_EQUAL(0, receiver.incomplete());
}

TEST(RawReceiver, ListeningCanBeginAnywhere) {
  for (const int number : {4, 5}) CHECK_FALSE(receiver.take(page(number, 1)).has_value());
  CHECK_TRUE(takeSet(2).has_value());
  LONGS_EQUAL(0, receiver.incomplete());
}

TEST(RawReceiver, AFingerOfMoreGaugesGivesNothing) {
  receiver = RawReceiver(kNode, 12);
  for (int number = 0; number < 3; ++number) receiver.take(page(number, 1));
  CHECK_TRUE(receiver.take(page(3, 1)).has_value());
  receiver.requireAllGauges();
  for (const int sample : {1, 2})
    for (int number = sample == 1 ? 4 : 0; number < 6; ++number)
      CHECK_FALSE(receiver.take(page(number, sample)).has_value());
  checkMismatch("node 5 has more gauges than gauges.count = 12: give its config, -c",
                [this] { receiver.requireAllGauges(); });
}

TEST(RawReceiver, AFingerOfFewerGaugesIsNamedAsThat) {
  receiver = RawReceiver(kNode, 24);
  receiver.requireEnoughGauges();  // of a finger that sends nothing it isn't known
  CHECK_FALSE(receiver.sendsAny());
  for (int number = 0; number < 6; ++number) receiver.take(page(number, 1));
  CHECK_TRUE(receiver.sendsAny());
  checkMismatch("the config has gauges.count = 24, the finger sends 16",
                [this] { receiver.requireEnoughGauges(); });
}

TEST(RawReceiver, OtherNodesAndFramesAreNotLookedAt) {
  for (int number = 0; number < 6; ++number) {
    CHECK_FALSE(receiver.take(page(number, 1, RawKind::kReadings, kNode + 1)).has_value());
    CHECK_FALSE(receiver.take({.id = 0x405, .length = 7}).has_value());
  }
  LONGS_EQUAL(0, receiver.incomplete());
}
