#include "host/can/loopback_port.hpp"

#include <memory>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using can::LoopbackPort;

TEST_GROUP(LoopbackPort) {
  static constexpr CanFrame kFrame{.id = 0x181, .length = 1, .data = {9}};
  can::LoopbackBus bus;
  LoopbackPort first{bus};

  void fill(LoopbackPort & from) {
    for (std::size_t i = 0; i < LoopbackPort::kCapacity; ++i) CHECK_TRUE(from.send({.id = 0x100}));
  }
};

TEST(LoopbackPort, EveryOtherPortHearsAFrame) {
  LoopbackPort second(bus);
  LoopbackPort third(bus);
  CHECK_TRUE(second.send(kFrame));
  CHECK_TRUE(first.receive() == kFrame);
  CHECK_TRUE(third.receive() == kFrame);
  CHECK_FALSE(second.receive().has_value());
}

TEST(LoopbackPort, AFrameThatOnePortHasNoRoomForReachesNone) {
  LoopbackPort second(bus);
  fill(second);
  LoopbackPort third(bus);
  CHECK_FALSE(second.send(kFrame));
  CHECK_FALSE(third.receive().has_value());
  first.receive();
  CHECK_TRUE(second.send(kFrame));
  CHECK_TRUE(third.receive() == kFrame);
}

TEST(LoopbackPort, AFullPortCanItselfSend) {
  LoopbackPort second(bus);
  fill(second);
  CHECK_TRUE(first.send(kFrame));
  CHECK_TRUE(second.receive() == kFrame);
}

TEST(LoopbackPort, APortThatLeavesNoLongerCounts) {
  auto second = std::make_unique<LoopbackPort>(bus);
  fill(first);
  CHECK_FALSE(first.send(kFrame));
  second.reset();
  CHECK_TRUE(first.send(kFrame));
}

TEST(LoopbackPort, TwoBusesAreApart) {
  can::LoopbackBus otherBus;
  LoopbackPort other(otherBus);
  CHECK_TRUE(first.send(kFrame));
  CHECK_FALSE(other.receive().has_value());
}
