#include "tests/doubles/fake_can_port.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using hal::CanState;

TEST_GROUP(FakeCanPort) {
  static constexpr CanFrame kFrame{.id = 0x181, .length = 1, .data = {9}};
  doubles::FakeCanPort port;
};

TEST(FakeCanPort, WhatWasSentIsKept) {
  CHECK_TRUE(port.send(kFrame));
  LONGS_EQUAL(1, port.sent.size());
  CHECK_TRUE(port.sent[0] == kFrame);
}

TEST(FakeCanPort, ABusyPortTakesNothing) {
  port.busy = true;
  CHECK_FALSE(port.send(kFrame));
  LONGS_EQUAL(0, port.sent.size());
}

TEST(FakeCanPort, TakesAsManyFramesAsThereIsRoom) {
  port.room = 1;
  CHECK_TRUE(port.send(kFrame));
  CHECK_FALSE(port.send(kFrame));
  LONGS_EQUAL(1, port.sent.size());
}

TEST(FakeCanPort, BusOffAndDownTakeNothing) {
  for (const CanState state : {CanState::kBusOff, CanState::kDown}) {
    port.bus.state = state;
    CHECK_FALSE(port.send(kFrame));
    CHECK_TRUE(port.status().state == state);
  }
  port.bus.state = CanState::kPassive;
  CHECK_TRUE(port.send(kFrame));
  LONGS_EQUAL(1, port.sent.size());
}
