#include "host/can/loss_counter.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <cstdlib>
#include <random>
#include <utility>

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
  void tables(std::uint8_t crc, std::uint16_t uptime_s, FingerState state = FingerState::kRun) {
    counter_.count("can0", encode(HeartbeatFrame{.state = state, .uptime_s = uptime_s, .table_crc = crc}, 1));
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

TEST(LossCounter, TwoFingersOfOneNumberAreToldApartFromLosses) {
  for (int i = 0; i < 300; ++i) contact(i), contact(i + 100);
  CHECK_TRUE(only().twoSenders);
  LONGS_EQUAL(0, only().lost);
}

TEST(LossCounter, TwoFingersAreNoticedWhateverTheirRates) {
  for (int i = 0; i < 40; ++i) {
    for (int k = 0; k < 5; ++k) contact(5 * i + k);
    contact(i + 17);
  }
  CHECK_TRUE(only().twoSenders);
}

TEST(LossCounter, TwoFingersInStepAreNoticedByWhatTheySay) {
  for (int i = 0; i < 9; ++i) {
    contact(i);
    counter_.count("can0",
                   encode(ContactFrame{.angle_cdeg = 7, .sequence = static_cast<std::uint8_t>(i)}, 1));
  }
  CHECK_TRUE(only().twoSenders);
}

TEST(LossCounter, TwoSilentFingersAreNoticedByTheirUptimes) {
  for (int i = 0; i < 9; ++i) heartbeat(100), heartbeat(5);
  CHECK_TRUE(only().twoSenders);
}

TEST(LossCounter, TwoFingersThatStartedTogetherBeatTwiceAsOften) {
  for (int second = 0; second < 5; ++second)
    for (int i = 0; i < 20; ++i) heartbeat(second);
  CHECK_TRUE(only().twoSenders);
}

TEST(LossCounter, TwoFingersThatStartedWithinTwoSecondsAreNoticed) {
  for (const int apart_s : {1, 2}) {
    counter_ = {};
    for (int second = 10; second < 13; ++second)
      for (int i = 0; i < 10; ++i) heartbeat(second), heartbeat(second - apart_s);
    CHECK_TRUE(only().twoSenders);
    LONGS_EQUAL(0, only().restarts);
  }
}

TEST(LossCounter, AFingerThatStartsAgainAndAgainIsOne) {
  for (int i = 0; i < 50; ++i) heartbeat(0), heartbeat(1), heartbeat(2);
  CHECK_FALSE(only().twoSenders);
}

TEST(LossCounter, ATwinIsForgottenUntilItIsHeardAgain) {
  for (int i = 0; i < 9; ++i) heartbeat(100), heartbeat(5);
  counter_.forgetTwin("can0", 1);
  CHECK_FALSE(only().twoSenders);
  for (int i = 0; i < 9; ++i) heartbeat(100), heartbeat(5);
  CHECK_TRUE(only().twoSenders);
}

TEST(LossCounter, OneFingerThatRunsForDaysIsOne) {
  for (int i = 0; i < 1000; ++i) heartbeat(0xFFFE);
  for (int second = 0; second < 100; ++second)
    for (int i = 0; i < 11; ++i) heartbeat(second);
  CHECK_FALSE(only().twoSenders);
}

TEST(LossCounter, TwoBoardsOfOneNumberAreNoticed) {
  for (int i = 0; i < 9; ++i)
    counter_.count("can0", encode(InfoFrame{.board = static_cast<std::uint8_t>(i % 2 == 0 ? 7 : 9)}, 1));
  CHECK_TRUE(only().twoSenders);
}

TEST(LossCounter, TwoFingersOfOtherTablesAreNoticedHoweverLongTheyRun) {
  for (int i = 0; i < 9; ++i) tables(static_cast<std::uint8_t>(i % 2 == 0 ? 0x2C : 0x8F), 0xFFFE);
  CHECK_TRUE(only().twoSenders);
}

TEST(LossCounter, AFingerThatIsSentOtherTablesAgainAndAgainIsOne) {
  for (int i = 0; i < 9; ++i) {
    const auto crc = static_cast<std::uint8_t>(i % 2 == 0 ? 0x2C : 0x8F);
    tables(crc, 0, FingerState::kZeroing);
    tables(crc, 2);
    tables(0, 3, FingerState::kFault);
  }
  CHECK_FALSE(only().twoSenders);
}

TEST(LossCounter, TablesThatChangeAreNamed) {
  tables(0x2C, 100);
  STRCMP_EQUAL("", tableChangesText(only()).c_str());
  tables(0, 101, FingerState::kFault);
  tables(0x2C, 1);
  STRCMP_EQUAL("", tableChangesText(only()).c_str());
  tables(0x8F, 2);
  STRCMP_CONTAINS("(last bytes of their CRC-32: 2C, 8F)", tableChangesText(only()).c_str());
  counter_.count("can0", encode(HeartbeatFrame{.protocol = 4, .uptime_s = 3, .table_crc = 0x11}, 1));
  STRCMP_CONTAINS("(last bytes of their CRC-32: 2C, 8F)", tableChangesText(only()).c_str());
}

TEST(LossCounter, AFingerThatWasReplacedIsOne) {
  for (const std::uint8_t board : std::array<std::uint8_t, 5>{7, 7, 0, 9, 9})
    counter_.count("can0", encode(InfoFrame{.board = board}, 1));
  CHECK_FALSE(only().twoSenders);
}

// A tenth of the frames lost at random, for an hour at 500 a second: each gap looks like another sender's
// return with a chance of 1 in 256.
TEST(LossCounter, ManyLossesAreNoSecondSender) {
  std::mt19937 random(1);
  std::uint64_t lost = 0;
  std::uint64_t gap = 0;
  contact(0);
  for (int i = 1; i < 1'800'000; ++i) {
    if (random() % 10 != 0) {
      contact(i);
      lost += std::exchange(gap, 0);
    } else {
      ++gap;
    }
  }
  CHECK_FALSE(only().twoSenders);
  CHECK(std::llabs(static_cast<long long>(lost - only().lost)) < static_cast<long long>(lost / 100));
}
