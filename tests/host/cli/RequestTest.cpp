#include "host/cli/request.hpp"

#include <chrono>

#include "host/base/failure.hpp"
#include "tests/host/can/fake_bus_port.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::cli;

TEST_GROUP(Request) {
  static constexpr std::uint8_t kNode = 5;
  can::FakeBusPort bus;

  static can::Reply answered(CommandStatus status) {
    return {.sent = true, .response = responseTo(Command::kTare, status)};
  }
  /// So many fingers do so.
  void answer(int fingers) {
    bus.onSend = [this, fingers](const CanFrame&) {
      for (int finger = 0; finger < fingers; ++finger)
        bus.hear(responseTo(Command::kCount, CommandStatus::kDone), kNode);
    };
  }
  void checkRefused(ExitCode code, const char* message, const std::function<bool()>& goOn = {}) {
    try {
      requireOneFinger(bus, kNode, goOn);
    } catch (const Failure& failure) {
      LONGS_EQUAL(static_cast<int>(code), static_cast<int>(failure.code()));
      STRCMP_CONTAINS(message, failure.what());
      return;
    }
    FAIL("no failure");
  }
  static can::Reply alive(const HeartbeatFrame& heartbeat) { return {.sent = true, .heartbeat = heartbeat}; }

  void checkFails(const can::Reply& reply, ExitCode code, const char* message) {
    try {
      requireDone(reply, Command::kTare, bus, kNode);
    } catch (const Failure& failure) {
      LONGS_EQUAL(static_cast<int>(code), static_cast<int>(failure.code()));
      STRCMP_CONTAINS("fake0 node 5: ", failure.what());
      STRCMP_CONTAINS(message, failure.what());
      return;
    }
    FAIL("no failure");
  }
};

TEST(Request, WhatIsDoneIsDone) {
  requireDone(answered(CommandStatus::kDone), Command::kTare, bus, kNode);
  requireDone(answered(CommandStatus::kDoneTouched), Command::kTare, bus, kNode);
}

TEST(Request, ARefusalNamesItsReasonAndTheRemedy) {
  checkFails(
      answered(CommandStatus::kTouched), ExitCode::kFailure,
      "tare: Refused: something touches the finger (touched): let go of the finger and repeat; if nothing "
      "touches it, ");
  checkFails(answered(CommandStatus::kTouched), ExitCode::kFailure,
             "`strainfinger tare --can fake0 -n 5 --force`");
  checkFails(answered(CommandStatus::kBusy), ExitCode::kFailure, "(busy): try again");
  checkFails(answered(CommandStatus::kBusy), ExitCode::kFailure, "`strainfinger monitor --can fake0` shows");
  checkFails(answered(CommandStatus::kUnknownCommand), ExitCode::kFailure, "firmware");
  checkFails(answered(CommandStatus::kBadArgument), ExitCode::kFailure, "(bad_argument)");
  checkFails({.sent = true, .response = responseTo(Command::kKeep, CommandStatus::kWait, 45)},
             ExitCode::kFailure, "Not yet: its memory would wear out; try again in 45 s (wait)");
  checkFails(answered(static_cast<CommandStatus>(99)), ExitCode::kFailure, "(99)");
}

TEST(Request, NobodyThereIsToldFromAFingerThatDoesNotAnswer) {
  checkFails({.sent = true, .waited = std::chrono::seconds(3)}, ExitCode::kNoNode,
             "no answer within 3000 ms and no HEARTBEAT: start it");
  checkFails(alive({.state = FingerState::kFault}), ExitCode::kNoNode, "alive: state fault");
}

TEST(Request, AnotherProtocolIsAMismatch) {
  checkFails(alive({.protocol = 1}), ExitCode::kMismatch, "speaks protocol 1, this program 2");
}

TEST(Request, AnInterfaceThatTakesNothingIsNamed) {
  checkFails({.waited = can::kAskFor}, ExitCode::kNoInterface, "took no frame in 1000 ms: free it");
}

TEST(Request, ThatTwoFingersObeyedIsTold) {
  can::Reply reply = answered(CommandStatus::kDone);
  reply.responses = 2;
  checkFails(reply, ExitCode::kFailure,
             "tare: both have answered: two fingers have this node number: take one off the bus");
}

TEST(Request, OneFingerIsNeeded) {
  answer(1);
  requireOneFinger(bus, kNode);
  answer(2);
  checkRefused(ExitCode::kFailure,
               "fake0 node 5: two fingers have this node number: take one off the bus; "
               "`strainfinger config --can fake0 -n 5 --set-node NODE`");
  answer(0);
  checkRefused(ExitCode::kNoNode, "fake0 node 5: no answer within 1000 ms and no HEARTBEAT");
  checkRefused(ExitCode::kInterrupted, "interrupted", [] { return false; });
}

TEST(Request, AnotherProgramThatAsksTheFingerIsWaitedFor) {
  int asked = 0;
  bus.onSend = [&](const CanFrame&) {
    if (++asked < 3) bus.hear(wordRequest(7, 7), kNode);
    for (int answers = 0; answers < 2; ++answers)  // one is to the other program
      if (asked < 3 || answers == 0) bus.hear(responseTo(Command::kCount, CommandStatus::kDone), kNode);
  };
  requireOneFinger(bus, kNode);
  CHECK_TRUE(asked >= 3);
}

TEST(Request, WaitingForAnotherProgramCanBeInterrupted) {
  bus.onSend = [&](const CanFrame&) {
    bus.hear(wordRequest(7, 7), kNode);
    bus.hear(responseTo(Command::kCount, CommandStatus::kDone), kNode);
  };
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(200);
  checkRefused(ExitCode::kInterrupted, "interrupted",
               [end] { return std::chrono::steady_clock::now() < end; });
}

TEST(Request, AnotherProgramThatDoesNotEndIsTold) {
  bus.onSend = [&](const CanFrame&) {
    bus.hear(wordRequest(7, 7), kNode);
    for (int answers = 0; answers < 2; ++answers)  // one is to the other program
      bus.hear(responseTo(Command::kCount, CommandStatus::kDone), kNode);
  };
  try {
    requireOneFinger(bus, kNode, {}, std::chrono::milliseconds(500));
    FAIL("no failure");
  } catch (const Failure& failure) {
    LONGS_EQUAL(static_cast<int>(ExitCode::kFailure), static_cast<int>(failure.code()));
    STRCMP_CONTAINS("fake0 node 5: another program asks this finger, and has not ended within 0.5 s: ",
                    failure.what());
  }
}

TEST(Request, ANodeNumberThatAnotherFingerHasIsNotGiven) {
  requireNobody(bus, kNode);
  bus.onSend = [&](const CanFrame&) { bus.hear(HeartbeatFrame{.state = FingerState::kFault}, kNode); };
  try {
    requireNobody(bus, kNode);
    FAIL("no failure");
  } catch (const Failure& failure) {
    LONGS_EQUAL(static_cast<int>(ExitCode::kFailure), static_cast<int>(failure.code()));
    STRCMP_CONTAINS("fake0 node 5: there is a finger of this number already", failure.what());
  }
}

// A push ends with a restart, during which the finger says nothing.
TEST(Request, WhoHasWaitedAsksAgainAFingerThatStartsAnew) {
  int asked = 0;
  bus.onSend = [&](const CanFrame&) {
    if (++asked == 1) bus.hear(wordRequest(7, 7), kNode);
    if (asked != 2) bus.hear(responseTo(Command::kCount, CommandStatus::kDone), kNode);
  };
  requireOneFinger(bus, kNode);
  LONGS_EQUAL(3, asked);
}
