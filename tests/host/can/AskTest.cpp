#include "host/can/ask.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>

#include "host/can/socketcan_port.hpp"
#include "tests/doubles/fake_socket_calls.hpp"
#include "tests/host/can/fake_bus_port.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::can;
using doubles::FakeSocketCalls;

TEST_GROUP(Ask) {
  static constexpr std::uint8_t kNode = 5;
  static constexpr std::chrono::milliseconds kShort{20};
  FakeSocketCalls calls;
  SocketCanPort port{"can0", 500'000, {}, calls};

  void arrives(const CanFrame& frame) {
    canfd_frame raw{};
    raw.can_id = frame.id;
    raw.len = frame.length;
    std::copy_n(frame.data.begin(), frame.length, raw.data);
    calls.frames.push_back({.frame = raw});
  }
  Reply tare() { return ask(port, kNode, tareRequest(false), {.longest = kShort}); }
};

TEST(Ask, SendsTheRequestOnceAndGivesTheResponse) {
  arrives(encode(responseTo(Command::kTare, CommandStatus::kTouched), kNode));
  const Reply reply = tare();
  CHECK_TRUE(reply.sent);
  CHECK_TRUE(reply.response->status == CommandStatus::kTouched);
  LONGS_EQUAL(1, calls.written.size());
  LONGS_EQUAL(0x605, calls.written[0].can_id);
  LONGS_EQUAL(1, calls.written[0].data[1]);
}

TEST(Ask, NobodyAnswers) {
  const auto begin = std::chrono::steady_clock::now();
  const Reply reply = tare();
  CHECK_TRUE(std::chrono::steady_clock::now() - begin >= kShort);
  CHECK_TRUE(reply.sent);
  CHECK_TRUE(reply.waited >= kShort);
  CHECK_FALSE(reply.response.has_value());
  CHECK_FALSE(reply.heartbeat.has_value());
  LONGS_EQUAL(1, calls.written.size());
}

TEST(Ask, OtherFramesAreNoAnswer) {
  arrives(encode(responseTo(Command::kTare, CommandStatus::kDone), kNode + 1));
  arrives(encode(responseTo(Command::kContactRate, CommandStatus::kDone), kNode));
  arrives(encode(tareRequest(false), kNode));
  arrives({.id = 0x585, .length = 8, .data = {0x43, 0x18, 0x10}});  // a CANopen drive's
  CHECK_FALSE(tare().response.has_value());
}

TEST(Ask, TellsWhatTheFingersHeartbeatsSay) {
  arrives(encode(HeartbeatFrame{.state = FingerState::kRun}, kNode + 1));
  CHECK_FALSE(tare().heartbeat.has_value());
  arrives(encode(HeartbeatFrame{.state = FingerState::kFault}, kNode));
  CHECK_TRUE(tare().heartbeat->state == FingerState::kFault);
}

TEST(Ask, AFullQueueIsTriedAgain) {
  calls.writeResults = {-ENOBUFS, -ENOBUFS};
  CHECK_TRUE(tare().sent);
  LONGS_EQUAL(1, calls.written.size());
  LONGS_EQUAL(3, calls.writes);
}

TEST(Ask, AnInterfaceThatTakesNothingIsTold) {
  calls.writeResults.assign(1'000'000, -ENOBUFS);
  CHECK_FALSE(tare().sent);
}

TEST(Ask, WhatCameBeforeTheRequestIsNoAnswer) {
  calls.writeResults = {-ENOBUFS};
  arrives(encode(responseTo(Command::kTare, CommandStatus::kDone), kNode));
  CHECK_FALSE(tare().response.has_value());
}

TEST(Ask, EndsWhenItIsStopped) {
  int asked = 0;
  const Reply reply = ask(port, kNode, tareRequest(false),
                          {.longest = std::chrono::hours(1), .goOn = [&] { return ++asked < 3; }});
  CHECK_TRUE(reply.sent);
  CHECK_FALSE(reply.response.has_value());
}

TEST(Ask, AFingerAnswersOnce) {
  arrives(encode(responseTo(Command::kTare, CommandStatus::kDone), kNode));
  CHECK_FALSE(tare().hasTwin());
  for (int twins = 0; twins < 2; ++twins)
    arrives(encode(responseTo(Command::kTare, CommandStatus::kDone), kNode));
  CHECK_TRUE(tare().hasTwin());
}

TEST(Ask, ThatTheNodeSendsRawIsNoticed) {
  arrives(encode(RawFrame{}, kNode + 1));
  CHECK_FALSE(tare().sendsRaw);
  arrives(encode(RawFrame{}, kNode));
  CHECK_TRUE(tare().sendsRaw);
}

TEST(Ask, AnAnswerToSomebodyElseIsNoTwins) {
  arrives(encode(tareRequest(false), kNode));
  for (int answers = 0; answers < 2; ++answers)
    arrives(encode(responseTo(Command::kTare, CommandStatus::kDone), kNode));
  CHECK_FALSE(tare().hasTwin());
}

namespace {

/// On which each request is answered, the first `twinUntil` of them by a twin as well, a little later.
class TwinBus : public FakeBusPort {
 public:
  explicit TwinBus(int twinUntil) : twinUntil_(twinUntil) {
    onSend = [this](const CanFrame&) { due_ = ++asked <= twinUntil_ ? 2 : 1; };
  }
  bool waitReadable(std::chrono::milliseconds timeout) noexcept override {
    if (due_-- > 0)
      hear(responseTo(Command::kCount, CommandStatus::kDone), kNode);
    else
      std::this_thread::sleep_for(timeout);
    return !toHear.empty();
  }

  static constexpr std::uint8_t kNode = 5;
  int asked = 0;

 private:
  int twinUntil_, due_ = 0;
};

}  // namespace

TEST_GROUP(AskWhoIsThere) {};

TEST(AskWhoIsThere, ASecondAnswerIsWaitedFor) {
  TwinBus bus(2);
  CHECK_TRUE(askWhoIsThere(bus, TwinBus::kNode).hasTwin());
  for (const CanFrame& frame : bus.sent) CHECK_TRUE(frame == encode(countRequest(Count::kErases), bus.kNode));
}

TEST(AskWhoIsThere, OneFingerIsAskedOnceAndSoonHeard) {
  TwinBus bus(0);
  const Reply reply = askWhoIsThere(bus, TwinBus::kNode);
  CHECK_TRUE(reply.response.has_value());
  CHECK_FALSE(reply.hasTwin());
  LONGS_EQUAL(1, bus.asked);
  CHECK_TRUE(reply.waited < kAskFor / 2);
}

TEST(AskWhoIsThere, AnAnswerThatCameTwiceByChanceIsNoTwins) {
  TwinBus bus(1);
  CHECK_FALSE(askWhoIsThere(bus, TwinBus::kNode).hasTwin());
  LONGS_EQUAL(2, bus.asked);
}
