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
  void patch(int sequence, int contacts = 1) {
    counter_.count("can0", encode(PatchFrame{.contacts = static_cast<std::uint8_t>(contacts),
                                             .sequence = static_cast<std::uint8_t>(sequence)},
                                  1));
  }
  void contact2(int sequence) {
    counter_.count("can0", encode(Contact2Frame{{.sequence = static_cast<std::uint8_t>(sequence)}}, 1));
  }
  void force2(int sequence) {
    counter_.count("can0", encode(Force2Frame{{.sequence = static_cast<std::uint8_t>(sequence)}}, 1));
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
  for (int i = 250; i < 1000; ++i) contact(i), force(i), patch(i);
  LONGS_EQUAL(2250, only().received);
  LONGS_EQUAL(0, only().lost);
}

TEST(LossCounter, GapsAreLostFrames) {
  contact(254);
  contact(2);  // 255, 0 and 1 are missing
  force(254);
  force(0);  // 255 is missing
  patch(254);
  patch(1);  // 255 and 0 are missing
  LONGS_EQUAL(6, only().received);
  LONGS_EQUAL(6, only().lost);
}

TEST(LossCounter, ASecondContactThatComesAndGoesIsNoLoss) {
  for (int i = 0; i < 300; ++i) {
    const bool two = i % 3 == 0;
    contact(i), force(i), patch(i, two ? 2 : 1);
    if (two) contact2(i), force2(i);
  }
  LONGS_EQUAL(1100, only().received);
  LONGS_EQUAL(0, only().lost);
}

TEST(LossCounter, ASecondContactMayComeBeforeItsPatch) {
  for (int i = 0; i < 300; ++i) contact(i), contact2(i), force(i), force2(i), patch(i, 2);
  LONGS_EQUAL(0, only().lost);
}

TEST(LossCounter, AFrameOfASecondContactThatWasAnnouncedAndDidNotComeIsLost) {
  patch(0, 2);
  force2(0);
  patch(1, 2);  // CONTACT2 of 0 is missing
  contact2(1);
  patch(2, 2);  // FORCE2 of 1 is missing
  patch(3, 1);  // both of 2 are missing
  patch(4, 1);
  LONGS_EQUAL(4, only().lost);
}

TEST(LossCounter, ARepeatedPatchAnnouncesNothingNew) {
  patch(0, 2);
  patch(0, 2);
  LONGS_EQUAL(0, only().lost);
  LONGS_EQUAL(1, only().repeated);
}

TEST(LossCounter, TheSameNumberAgainIsARepetition) {
  contact(7);
  contact(7);
  LONGS_EQUAL(0, only().lost);
  LONGS_EQUAL(1, only().repeated);
}

TEST(LossCounter, ARestartIsNoLoss) {
  heartbeat(100);
  contact(50), patch(50, 2);
  heartbeat(0);
  contact(0), patch(0);
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
