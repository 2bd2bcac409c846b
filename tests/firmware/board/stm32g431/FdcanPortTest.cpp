#include "firmware/board/stm32g431/fdcan_port.hpp"

#include <algorithm>
#include <bit>

#include "firmware/board/stm32g431/can_rates.hpp"
#include "tests/doubles/fake_clock.hpp"
#include "tests/firmware/board/stm32g431/fake_fdcan.hpp"
#include "tests/hal/can_port_contract.hpp"

using namespace strainfinger;
using namespace strainfinger::stm32g431;

namespace {

/// Even identifiers: the newest wins. From 0x400 on: in the background.
constexpr SendRule rule(std::uint16_t id) { return {.newestWins = id % 2 == 0, .background = id >= 0x400}; }
constexpr SendRule noRule(std::uint16_t) { return {}; }

using PlainPort = FdcanPort<doubles::FakeBus, doubles::FakeClock, noRule>;
using RuledPort = FdcanPort<doubles::FakeBus, doubles::FakeClock, rule>;
static_assert(hal::CanPort<PlainPort>);

constexpr BitTiming kTiming = *canTiming(ClockSource::kCrystal, 1'000'000);

/// Hears everything. The main loop turns after each frame, as it does on the board.
class FdcanBench {
 public:
  FdcanBench() { CHECK_TRUE(port_.start({.timing = kTiming})); }
  PlainPort& port() { return port_; }
  bool otherSends(const CanFrame& frame) {
    const bool sent = controller_.deliver(frame);
    port_.poll();
    return sent;
  }
  std::optional<CanFrame> otherHears() {
    if (controller_.heard.empty()) return std::nullopt;
    const CanFrame frame = controller_.heard.front();
    controller_.heard.pop_front();
    return frame;
  }
  std::optional<CanFrame> portHears() { return port_.receive(); }
  /// Others have the bus, and all buffers wait: those frames are never heard, the controller is stopped for
  /// them.
  void block() {
    controller_.busy = true;
    for (std::uint16_t id = 0x301; id <= 0x303; ++id) port_.send({.id = id});
  }
  void unblock() {
    controller_.goBusOff();
    port_.poll();
    controller_.recessiveBitsPass();
    controller_.free();
  }

 private:
  doubles::FakeFdcan controller_;
  doubles::FakeClock clock_;
  PlainPort port_{doubles::FakeBus(controller_.registers), clock_};
};

}  // namespace

CAN_PORT_CONTRACT(Fdcan, FdcanBench)

TEST_GROUP(FdcanPort) {
  doubles::FakeFdcan controller;
  doubles::FakeClock clock{0xFFFF'0000};  // wraps soon
  RuledPort port{doubles::FakeBus(controller.registers), clock};

  void start(FdcanSettings settings = {.timing = kTiming}) { CHECK_TRUE(port.start(settings)); }

  static CanFrame frame(std::uint16_t id, std::uint8_t value = 0) {
    return {.id = id, .length = 1, .data = {value}};
  }

  void hears(std::initializer_list<CanFrame> frames) {
    CHECK_TRUE(std::equal(frames.begin(), frames.end(), controller.heard.begin(), controller.heard.end()));
  }

  hal::CanState state() { return port.status().state; }

  /// Bus-off, and the wait until the port goes back on the bus. [ms]
  std::uint32_t backOff_ms() {
    controller.goBusOff();
    port.poll();
    std::uint32_t waited_ms = 0;
    for (; controller.registers.field(Fdcan::Cccr::init) != 0 && waited_ms < 5000; ++waited_ms) {
      clock.advance(1000);
      port.poll();
    }
    controller.recessiveBitsPass();
    return waited_ms;
  }
};

TEST(FdcanPort, IsDownUntilStarted) {
  CHECK_TRUE(state() == hal::CanState::kDown);
  CHECK_FALSE(port.send(frame(1)));
  CHECK_FALSE(port.receive().has_value());
  CHECK_FALSE(port.status().txErrors.has_value());
}

TEST(FdcanPort, WritesProtectedRegistersOnlyWhileItMay) {
  start({.timing = kTiming, .dataTiming = fdDataTiming(ClockSource::kCrystal)});
  CHECK_TRUE(controller.isOnBus());
  LONGS_EQUAL(0, controller.registers.field(Fdcan::Cccr::configurable));
}

TEST(FdcanPort, WritesTheBitTiming) {
  start();  // 24 quanta of 1 clock: 1 + 19 + 4
  LONGS_EQUAL(0, controller.registers.field(Fdcan::Nbtp::prescaler));
  LONGS_EQUAL(18, controller.registers.field(Fdcan::Nbtp::segment1));
  LONGS_EQUAL(3, controller.registers.field(Fdcan::Nbtp::segment2));
  LONGS_EQUAL(3, controller.registers.field(Fdcan::Nbtp::jump));
  LONGS_EQUAL(1, controller.registers.field(Fdcan::Txbc::queue));
  LONGS_EQUAL(0, controller.registers.field(Fdcan::Cccr::fd));
}

TEST(FdcanPort, LetsFdFramesPassWithADataTiming) {
  start({.timing = kTiming, .dataTiming = fdDataTiming(ClockSource::kCrystal)});  // 12 quanta: 1 + 9 + 2
  LONGS_EQUAL(1, controller.registers.field(Fdcan::Cccr::fd));
  LONGS_EQUAL(1, controller.registers.field(Fdcan::Cccr::bitRateSwitch));
  LONGS_EQUAL(8, controller.registers.field(Fdcan::Dbtp::segment1));
  LONGS_EQUAL(1, controller.registers.field(Fdcan::Dbtp::segment2));
  controller.deliver(frame(1), 0, Element1::fd(1).value);
  CHECK_FALSE(port.receive().has_value());
}

TEST(FdcanPort, GivesUpOnAControllerThatDoesNotEnterInit) {
  controller.answers = false;
  controller.registers.setField(Fdcan::Cccr::init, 0);
  CHECK_FALSE(port.start({.timing = kTiming}));
  CHECK_TRUE(state() == hal::CanState::kDown);
}

TEST(FdcanPort, GivesUpOnAControllerThatDoesNotLeaveInit) {
  controller.answers = false;
  CHECK_FALSE(port.start({.timing = kTiming}));
  CHECK_FALSE(port.send(frame(1)));
}

TEST(FdcanPort, ReceivesOnlyWhatItListensTo) {
  static constexpr std::array<std::uint16_t, 3> kIds{0x600, 0x605, 0x705};
  start({.timing = kTiming, .listensTo = kIds});
  for (std::uint16_t id = 0; id <= kMaxCanId; ++id) {
    controller.deliver(frame(id));
    const bool wanted = id == 0x600 || id == 0x605 || id == 0x705;
    CHECK_EQUAL(wanted, port.receive().has_value());
  }
  LONGS_EQUAL(0, port.status().missed);
}

TEST(FdcanPort, IgnoresRemoteAndExtendedFrames) {
  start();
  CHECK_FALSE(controller.deliver(frame(1), Element0::remote.mask));
  CHECK_FALSE(controller.deliver(frame(1), Element0::extended.mask));
  CHECK_FALSE(port.receive().has_value());
}

TEST(FdcanPort, DropsRemoteAndExtendedFramesThatGotThroughTheFilters) {
  start();
  controller.registers.setField(Fdcan::Rxgfc::rejectStandardRemote, 0);
  controller.registers.setField(Fdcan::Rxgfc::otherExtended, 0);
  CHECK_TRUE(controller.deliver(frame(1), Element0::remote.mask));
  CHECK_TRUE(controller.deliver(frame(1), Element0::extended.mask));
  CHECK_FALSE(port.receive().has_value());
}

TEST(FdcanPort, TakesLengthsAboveEightForEight) {
  start();
  controller.deliver({.id = 1, .length = 8, .data = {1, 2, 3, 4, 5, 6, 7, 8}}, 0, Element1::length(15).value);
  const auto received = port.receive();
  CHECK_TRUE(received == (CanFrame{.id = 1, .length = 8, .data = {1, 2, 3, 4, 5, 6, 7, 8}}));
}

TEST(FdcanPort, CountsWhatAFullFifoLost) {
  start();
  for (std::uint8_t i = 0; i < 5; ++i) controller.deliver(frame(1, i));
  LONGS_EQUAL(1, port.status().missed);  // at least: the controller only flags it
  for (std::uint8_t i = 0; i < 3; ++i) CHECK_TRUE(port.receive() == frame(1, i));
  controller.deliver(frame(1));
  LONGS_EQUAL(1, port.status().missed);
}

TEST(FdcanPort, CountsWhatNobodyFetched) {
  start();
  for (std::uint8_t i = 0; i < 10; ++i) {
    controller.deliver(frame(1, i));
    port.poll();
  }
  LONGS_EQUAL(2, port.status().missed);
  for (std::uint8_t i = 0; i < 8; ++i) CHECK_TRUE(port.receive() == frame(1, i));
  CHECK_FALSE(port.receive().has_value());
}

TEST(FdcanPort, HoldsOneFrameOfAnIdentifier) {
  start();
  controller.busy = true;
  CHECK_TRUE(port.send(frame(5, 1)));
  CHECK_FALSE(port.send(frame(5, 2)));
  controller.free();
  CHECK_TRUE(port.send(frame(5, 2)));
  hears({frame(5, 1), frame(5, 2)});
  LONGS_EQUAL(0, port.status().dropped);
}

TEST(FdcanPort, TheNewestFrameReplacesOneThatWaits) {
  start({.timing = kTiming});
  controller.busy = true;
  for (std::uint8_t i = 0; i < 10; ++i) CHECK_TRUE(port.send(frame(4, i)));
  LONGS_EQUAL(9, port.status().dropped);
  CHECK_EQUAL(1, std::popcount(controller.pending()));
  controller.free();
  hears({frame(4, 9)});
}

TEST(FdcanPort, AFrameOnTheWireIsNotReplaced) {
  start({.timing = kTiming});
  controller.busy = true;
  port.send(frame(4, 1));
  controller.beginTransmission();
  CHECK_FALSE(port.send(frame(4, 2)));
  controller.endTransmission(true);
  controller.free();
  CHECK_TRUE(port.send(frame(4, 3)));
  hears({frame(4, 1), frame(4, 3)});
  LONGS_EQUAL(0, port.status().dropped);
}

TEST(FdcanPort, AFrameCancelledOnTheWireThatFailsCountsAsDropped) {
  start({.timing = kTiming});
  controller.busy = true;
  port.send(frame(4, 1));
  controller.beginTransmission();
  CHECK_FALSE(port.send(frame(4, 2)));
  controller.endTransmission(false);
  controller.free();
  CHECK_TRUE(port.send(frame(4, 2)));
  hears({frame(4, 2)});
  LONGS_EQUAL(1, port.status().dropped);
}

TEST(FdcanPort, TheLowestIdentifierGoesFirst) {
  start();
  controller.busy = true;
  for (const std::uint16_t id : std::array<std::uint16_t, 3>{0x705, 0x285, 0x185})
    CHECK_TRUE(port.send(frame(id)));
  CHECK_FALSE(port.send(frame(0x485)));
  controller.free();
  hears({frame(0x185), frame(0x285), frame(0x705)});
}

TEST(FdcanPort, FramesInTheBackgroundShareOneBuffer) {
  start({.timing = kTiming});
  controller.busy = true;
  CHECK_TRUE(port.send(frame(0x401)));
  CHECK_FALSE(port.send(frame(0x500)));
  CHECK_TRUE(port.send(frame(0x185)));
  CHECK_TRUE(port.send(frame(0x285)));
  controller.free();
  CHECK_TRUE(port.send(frame(0x500)));
  hears({frame(0x185), frame(0x285), frame(0x401), frame(0x500)});
}

TEST(FdcanPort, AnOldFrameInTheBackgroundMakesRoomForAnother) {
  start({.timing = kTiming});
  controller.busy = true;
  CHECK_TRUE(port.send(frame(0x401)));
  clock.advance(200'000);
  CHECK_TRUE(port.send(frame(0x185)));
  clock.advance(199'999);
  CHECK_FALSE(port.send(frame(0x501)));
  clock.advance(1);
  CHECK_TRUE(port.send(frame(0x501)));
  LONGS_EQUAL(1, port.status().dropped);
  controller.free();
  hears({frame(0x185), frame(0x501)});
}

TEST(FdcanPort, AnOldFrameInTheBackgroundThatIsOnTheWireEndsWithItsTry) {
  start({.timing = kTiming});
  controller.busy = true;
  port.send(frame(0x401));
  clock.advance(400'000);
  controller.beginTransmission();
  CHECK_FALSE(port.send(frame(0x501)));
  controller.endTransmission(false);
  controller.free();
  CHECK_TRUE(port.send(frame(0x501)));
  hears({frame(0x501)});
  LONGS_EQUAL(1, port.status().dropped);
}

TEST(FdcanPort, AFrameThatIsSaidAgainAndAgainDoesNotKeepTheBackgroundForItself) {
  start({.timing = kTiming});
  controller.busy = true;
  for (std::uint8_t i = 0; i < 4; ++i) {
    CHECK_TRUE(port.send(frame(0x700, i)));
    clock.advance(99'999);
    CHECK_FALSE(port.send(frame(0x481)));
  }
  clock.advance(4);
  CHECK_TRUE(port.send(frame(0x481)));
  CHECK_FALSE(port.send(frame(0x700, 5)));
  controller.free();
  hears({frame(0x481)});
}

TEST(FdcanPort, TheAgeOfOneThatWasSentIsNotThatOfTheNext) {
  start({.timing = kTiming});
  port.send(frame(0x401));
  clock.advance(1'000'000);
  controller.busy = true;
  CHECK_TRUE(port.send(frame(0x481)));
  CHECK_FALSE(port.send(frame(0x501)));
}

TEST(FdcanPort, AnOldFrameThatIsNotInTheBackgroundStays) {
  start({.timing = kTiming});
  controller.busy = true;
  port.send(frame(0x185));
  clock.advance(1'000'000);
  CHECK_TRUE(port.send(frame(0x401)));
  controller.free();
  hears({frame(0x185), frame(0x401)});
}

TEST(FdcanPort, AFloodDelaysButNeverPilesUp) {
  start({.timing = kTiming});
  controller.busy = true;
  for (int i = 0; i < 60'000; ++i) port.send(frame(4, static_cast<std::uint8_t>(i)));
  LONGS_EQUAL(59'999, port.status().dropped);
  controller.free();
  hears({frame(4, static_cast<std::uint8_t>(59'999))});
}

TEST(FdcanPort, TellsTheErrorCountersAndState) {
  start();
  controller.registers.word<Fdcan::Ecr>() = (Fdcan::Ecr::txErrors(97) | Fdcan::Ecr::rxErrors(12)).value;
  controller.registers.setField(Fdcan::Psr::warning, 1);
  LONGS_EQUAL(97, *port.status().txErrors);
  LONGS_EQUAL(12, *port.status().rxErrors);
  CHECK_TRUE(state() == hal::CanState::kWarning);
  controller.registers.setField(Fdcan::Psr::passive, 1);
  CHECK_TRUE(state() == hal::CanState::kPassive);
}

TEST(FdcanPort, TellsAReceiveCounterBeyond127As128) {
  start();
  controller.registers.word<Fdcan::Ecr>() = (Fdcan::Ecr::rxPassive(1) | Fdcan::Ecr::rxErrors(127)).value;
  LONGS_EQUAL(128, *port.status().rxErrors);
}

TEST(FdcanPort, AloneOnTheBusItStaysPassiveAndKeepsTheNewest) {
  start({.timing = kTiming});
  controller.busy = true;
  controller.registers.setField(Fdcan::Psr::passive, 1);
  for (std::uint8_t i = 0; i < 100; ++i) port.send(frame(4, i));
  CHECK_TRUE(state() == hal::CanState::kPassive);
  controller.free();
  hears({frame(4, 99)});
}

TEST(FdcanPort, AfterBusOffNothingStaleGoesOut) {
  start();
  controller.busy = true;
  port.send(frame(1, 1));
  controller.goBusOff();
  CHECK_TRUE(state() == hal::CanState::kBusOff);
  CHECK_FALSE(port.send(frame(1, 2)));
  controller.recessiveBitsPass();
  controller.free();
  CHECK_TRUE(port.send(frame(1, 3)));
  hears({frame(1, 3)});
  LONGS_EQUAL(1, port.status().dropped);
  LONGS_EQUAL(1, port.status().busOffs);
}

TEST(FdcanPort, WaitsLongerAfterEachBusOff) {
  start();
  for (const std::uint32_t expected_ms : {0U, 10U, 100U, 1000U, 1000U})
    LONGS_EQUAL(expected_ms, backOff_ms());
  LONGS_EQUAL(5, port.status().busOffs);
}

TEST(FdcanPort, AFrameThatGotThroughEndsTheWaiting) {
  start();
  backOff_ms();
  LONGS_EQUAL(10, backOff_ms());
  CHECK_TRUE(port.send(frame(1)));
  LONGS_EQUAL(0, backOff_ms());
}

TEST(FdcanPort, WhatArrivedBeforeBusOffIsStillReceived) {
  start();
  controller.deliver(frame(7));
  controller.goBusOff();
  CHECK_TRUE(port.receive() == frame(7));
}

TEST(FdcanPort, AFreshFrameIsOutWithinTenMillisecondsOfTheFirstBusOff) {
  start();
  controller.goBusOff();
  port.poll();
  clock.advance(1419);  // 129 * 11 bits at 1 Mbit/s
  controller.recessiveBitsPass();
  CHECK_TRUE(port.send(frame(1)));
  hears({frame(1)});
}
