#include "host/can/loss_counter.hpp"

#include <CppUTest/TestHarness.h>

#include "common/frames.hpp"

using namespace strainfinger;
using namespace strainfinger::can;

TEST_GROUP(LossCounter) {
  LossCounter counter_;

  void contact(int sequence, std::uint8_t node = 1) {
    counter_.count("can0", encode(ContactFrame{.sequence = static_cast<std::uint8_t>(sequence)}, node));
  }
  void force(int sequence) {
    counter_.count("can0", encode(ForceFrame{.sequence = static_cast<std::uint8_t>(sequence)}, 1));
  }
  void heartbeat(int uptime_s) {
    counter_.count("can0", encode(HeartbeatFrame{.uptime_s = static_cast<std::uint16_t>(uptime_s)}, 1));
  }
  NodeCount only() {
    LONGS_EQUAL(1, counter_.counts().size());
    return counter_.counts().front();
  }
};

TEST(LossCounter, CountsNothingAtFirst) { CHECK(counter_.counts().empty()); }

TEST(LossCounter, SequencesWithoutGapsLoseNothing) {
  for (int i = 250; i < 1000; ++i) contact(i), force(i);
  LONGS_EQUAL(1500, only().received);
  LONGS_EQUAL(0, only().lost);
}

TEST(LossCounter, GapsAreLostFrames) {
  contact(254);
  contact(2);  // 255, 0 and 1 are missing
  force(254);
  force(0);  // 255 is missing
  LONGS_EQUAL(4, only().received);
  LONGS_EQUAL(4, only().lost);
}

TEST(LossCounter, TheSameNumberAgainIsARepetition) {
  contact(7);
  contact(7);
  LONGS_EQUAL(0, only().lost);
  LONGS_EQUAL(1, only().repeated);
}

TEST(LossCounter, ARestartIsNoLoss) {
  heartbeat(100);
  contact(50);
  heartbeat(0);
  contact(0);
  LONGS_EQUAL(0, only().lost);
  LONGS_EQUAL(1, only().restarts);
}

TEST(LossCounter, AnUnknownUptimeIsNoRestart) {
  heartbeat(100);
  heartbeat(0xFFFF);
  heartbeat(100);
  LONGS_EQUAL(0, only().restarts);
}

TEST(LossCounter, RemembersTheProtocol) {
  contact(0);
  CHECK_FALSE(only().protocol.has_value());
  heartbeat(0);
  LONGS_EQUAL(kProtocolVersion, only().protocol.value());
}

TEST(LossCounter, NodesAndInterfacesAreCountedApart) {
  contact(1, 1);
  contact(9, 2);
  counter_.count("can1", encode(ContactFrame{.sequence = 100}, 1));
  LONGS_EQUAL(3, counter_.counts().size());
  for (const NodeCount& node : counter_.counts()) LONGS_EQUAL(0, node.lost);
}

TEST(LossCounter, OtherFramesAreNobodys) {
  counter_.count("can0", {0x80, 8, {}});
  counter_.count("can0", {0x181, 4, {}});
  CHECK(counter_.counts().empty());
}
