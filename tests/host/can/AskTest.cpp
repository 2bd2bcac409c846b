#include "host/can/ask.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>

#include "host/can/socketcan_port.hpp"
#include "tests/doubles/fake_socket_calls.hpp"

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
    can_frame raw{};
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
