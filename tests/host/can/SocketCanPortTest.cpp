#include "host/can/socketcan_port.hpp"

#include <linux/can/error.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "host/base/failure.hpp"
#include "tests/doubles/fake_socket_calls.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using can::SocketCanPort;
using doubles::FakeSocketCalls;
using hal::CanState;

TEST_GROUP(SocketCanPort) {
  static constexpr CanFrame kFrame{.id = 0x181, .length = 2, .data = {0xAB, 0xCD}};
  FakeSocketCalls calls;
  std::unique_ptr<SocketCanPort> port;

  void open(const std::string& interface = "can0") {
    port = std::make_unique<SocketCanPort>(interface, 500'000, can::BusFilter{}, calls);
  }

  /// The message opening fails with; its status is checked here.
  std::string openingMessage(const std::string& interface) {
    try {
      open(interface);
    } catch (const Failure& failure) {
      LONGS_EQUAL(3, static_cast<int>(failure.code()));
      LONGS_EQUAL(0, calls.openSockets());
      return failure.what();
    }
    FAIL("opened");
    return {};
  }

  static FakeSocketCalls::Read errorFrame(canid_t classes, std::uint8_t controller = 0, std::uint8_t tx = 0,
                                          std::uint8_t rx = 0) {
    canfd_frame frame{};
    frame.can_id = CAN_ERR_FLAG | classes;
    frame.len = CAN_ERR_DLC;
    frame.data[1] = controller;
    frame.data[6] = tx;
    frame.data[7] = rx;
    return {.frame = frame};
  }

  static FakeSocketCalls::Read dataFrame(canid_t id, std::uint8_t length = 0) {
    canfd_frame frame{};
    frame.can_id = id;
    frame.len = length;
    return {.frame = frame};
  }

  CanState stateAfter(const FakeSocketCalls::Read& read) {
    calls.errors.push_back(read);
    return port->status().state;
  }

  void interfaceGoesDown() {
    calls.errors.push_back({.result = -ENETDOWN});
    calls.frames.push_back({.result = -ENETDOWN});
    calls.flags = 0;
  }

  void interfaceIsRemoved() {
    calls.errors.push_back({.result = -ENODEV});
    calls.frames.push_back({.result = -ENODEV});
    calls.indexResult = -ENODEV;
  }

  void refusesOnce(int writeResult) {
    open();
    calls.writeResults = {writeResult};
    CHECK_FALSE(port->send(kFrame));
    LONGS_EQUAL(1, port->refused());
    CHECK_TRUE(port->send(kFrame));
    LONGS_EQUAL(1, port->refused());
    LONGS_EQUAL(1, calls.written.size());
  }
};

TEST(SocketCanPort, AMissingVirtualInterfaceIsNamedWithTheCommandThatMakesIt) {
  calls.indexResult = -ENODEV;
  STRCMP_EQUAL(
      "no CAN interface vcan0: make it with `sudo ip link add dev vcan0 type vcan && sudo ip link set vcan0 "
      "up`",
      openingMessage("vcan0").c_str());
}

TEST(SocketCanPort, AMissingAdapterIsNamedWithTheCommandThatBringsItUp) {
  calls.indexResult = -ENODEV;
  STRCMP_CONTAINS(
      "no CAN interface can1: plug the adapter in, then "
      "`sudo ip link set can1 up type can bitrate 500000 restart-ms 100`",
      openingMessage("can1").c_str());
}

TEST(SocketCanPort, AMissingSerialAdapterIsNamedWithTheCommandThatAttachesIt) {
  calls.indexResult = -ENODEV;
  STRCMP_CONTAINS("`sudo slcand -o -c -s8 -S 115200 /dev/ttyACM0 slcan0 && sudo ip link set slcan0 up`",
                  openingMessage("slcan0").c_str());
}

TEST(SocketCanPort, AnInterfaceThatIsDownIsNamedWithTheCommandThatBringsItUp) {
  calls.flags = 0;
  STRCMP_EQUAL("CAN interface vcan0 is down: bring it up with `sudo ip link set vcan0 up`",
               openingMessage("vcan0").c_str());
  STRCMP_EQUAL(
      "CAN interface can0 is down: bring it up with "
      "`sudo ip link set can0 up type can bitrate 500000 restart-ms 100`",
      openingMessage("can0").c_str());
}

TEST(SocketCanPort, AKernelWithoutCanIsTold) {
  for (const int error : {-EAFNOSUPPORT, -EPROTONOSUPPORT}) {
    calls.openResult = error;
    STRCMP_CONTAINS("cannot open vcan0: this kernel has no CAN sockets; `sudo modprobe can_raw`",
                    openingMessage("vcan0").c_str());
  }
}

TEST(SocketCanPort, AMissingPermissionIsTold) {
  for (const int error : {-EPERM, -EACCES}) {
    calls.openResult = error;
    STRCMP_EQUAL("cannot open can0: no permission for CAN sockets; run it with sudo",
                 openingMessage("can0").c_str());
  }
}

TEST(SocketCanPort, AnInterfaceThatIsNotCanIsTold) {
  calls.bindResult = -ENODEV;
  STRCMP_CONTAINS("eth0 is not a CAN interface: `ip -br link show type can`", openingMessage("eth0").c_str());
}

TEST(SocketCanPort, AnyOtherErrorIsTold) {
  calls.openResult = -EMFILE;
  STRCMP_EQUAL("cannot open can0: Too many open files", openingMessage("can0").c_str());
  calls.openResult = 0;
  calls.optionResult = -ENOMEM;
  STRCMP_EQUAL("cannot open can0: Cannot allocate memory", openingMessage("can0").c_str());
}

TEST(SocketCanPort, BothSocketsOrNone) {
  calls.opensThatWork = 1;
  STRCMP_EQUAL("cannot open can0: Too many open files", openingMessage("can0").c_str());
}

TEST(SocketCanPort, ANameThatNoInterfaceCanHaveIsTold) {
  STRCMP_EQUAL("no CAN interface '': a name has 1 to 15 characters", openingMessage("").c_str());
  STRCMP_EQUAL("no CAN interface 'a123456789012345': a name has 1 to 15 characters",
               openingMessage("a123456789012345").c_str());
  open("a12345678901234");
}

TEST(SocketCanPort, NoSocketIsLeftOpen) {
  open();
  LONGS_EQUAL(2, calls.openSockets());
  port.reset();
  LONGS_EQUAL(0, calls.openSockets());
}

TEST(SocketCanPort, TheKernelIsAskedForStandardDataFramesOnly) {
  open();
  const auto passes = [this](canid_t id) {
    return (id & calls.filters.at(0).can_mask) == (calls.filters.at(0).can_id & calls.filters.at(0).can_mask);
  };
  LONGS_EQUAL(1, calls.filters.size());
  CHECK_TRUE(passes(0) && passes(0x7FF));
  CHECK_FALSE(passes(0x123 | CAN_EFF_FLAG) || passes(0x123 | CAN_RTR_FLAG));
}

TEST(SocketCanPort, TheKernelIsAskedForTheIdentifiersOfTheFilterOnly) {
  SocketCanPort filtered("can0", 500'000, can::BusFilter{.id = 0x601, .mask = 0x7FF}, calls);
  LONGS_EQUAL(0x601, calls.filters.at(0).can_id);
  LONGS_EQUAL(0x7FF | CAN_EFF_FLAG | CAN_RTR_FLAG, calls.filters.at(0).can_mask);
}

TEST(SocketCanPort, AFrameComesWithTheTimeOfItsArrival) {
  open();
  auto read = dataFrame(0x222);
  read.time_ns = 1'609'779'922'655'421'000;
  calls.frames = {read};
  const auto timed = port->receiveTimed();
  LONGS_EQUAL(0x222, timed->frame.id);
  CHECK_TRUE(timed->time_ns == 1'609'779'922'655'421'000);
}

TEST(SocketCanPort, AFrameIsWrittenAsItIs) {
  open();
  CHECK_TRUE(port->send({.id = 0x7FF, .length = 1, .data = {0x5A, 0xFF}}));
  LONGS_EQUAL(0x7FF, calls.written.at(0).can_id);
  LONGS_EQUAL(1, calls.written.at(0).len);
  LONGS_EQUAL(0x5A, calls.written.at(0).data[0]);
  LONGS_EQUAL(0, calls.written.at(0).data[1]);
}

TEST(SocketCanPort, AFullQueueRefusesTheFrame) { refusesOnce(-ENOBUFS); }
TEST(SocketCanPort, AFullSocketRefusesTheFrame) { refusesOnce(-EAGAIN); }
TEST(SocketCanPort, AnInterfaceJustGoneDownRefusesTheFrame) { refusesOnce(-ENETDOWN); }
TEST(SocketCanPort, AHalfWrittenFrameIsRefused) { refusesOnce(sizeof(can_frame) - 1); }

TEST(SocketCanPort, AnInterruptedWriteIsRepeated) {
  open();
  calls.writeResults = {-EINTR, -EINTR};
  CHECK_TRUE(port->send(kFrame));
  LONGS_EQUAL(3, calls.writes);
  LONGS_EQUAL(1, calls.written.size());
}

TEST(SocketCanPort, AFrameNoBusCanCarryNeverReachesTheKernel) {
  open();
  CHECK_FALSE(port->send({.id = 0x800}));
  CHECK_FALSE(port->send({.id = 1, .length = 9}));
  LONGS_EQUAL(0, calls.writes);
  LONGS_EQUAL(2, port->refused());
}

TEST(SocketCanPort, BusOffRefusesFramesUntilTheControllerRestarts) {
  open();
  calls.errors = {errorFrame(CAN_ERR_BUSOFF)};
  CHECK_FALSE(port->send(kFrame));
  LONGS_EQUAL(0, calls.writes);
  CHECK_TRUE(port->status().state == CanState::kBusOff);
  calls.errors = {errorFrame(CAN_ERR_RESTARTED)};
  CHECK_TRUE(port->send(kFrame));
}

TEST(SocketCanPort, WhatItHadTakenIsKnownToBeLostThenEvenIfItIsBack) {
  open();
  const std::uint32_t before = port->status().busOffs;
  calls.errors = {errorFrame(CAN_ERR_BUSOFF), errorFrame(CAN_ERR_RESTARTED)};
  CHECK_TRUE(port->status().state == CanState::kActive);
  LONGS_EQUAL(before + 1, port->status().busOffs);
  interfaceGoesDown();
  LONGS_EQUAL(before + 2, port->status().busOffs);
}

TEST(SocketCanPort, AnInterfaceWithoutCarrierIsBusOff) {
  calls.flags = IFF_UP;
  open();
  CHECK_TRUE(port->status().state == CanState::kBusOff);
}

TEST(SocketCanPort, TheStateFollowsTheController) {
  open();
  CHECK_TRUE(port->status().state == CanState::kActive);
  CHECK_TRUE(stateAfter(errorFrame(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING)) == CanState::kWarning);
  CHECK_TRUE(stateAfter(errorFrame(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE)) == CanState::kPassive);
  CHECK_TRUE(stateAfter(errorFrame(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW)) == CanState::kPassive);
  CHECK_TRUE(stateAfter(errorFrame(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_WARNING)) == CanState::kWarning);
  CHECK_TRUE(stateAfter(errorFrame(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE | CAN_ERR_CRTL_RX_WARNING)) ==
             CanState::kPassive);
  CHECK_TRUE(stateAfter(errorFrame(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE)) == CanState::kActive);
  CHECK_TRUE(stateAfter(errorFrame(CAN_ERR_TX_TIMEOUT)) == CanState::kActive);
}

TEST(SocketCanPort, ErrorPassiveStillSends) {
  open();
  calls.errors = {errorFrame(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE)};
  CHECK_TRUE(port->send(kFrame));
}

TEST(SocketCanPort, CountersAreThoseOfTheNewestErrorFrameThatHasThem) {
  open();
  CHECK_FALSE(port->status().txErrors.has_value());
  calls.errors = {errorFrame(CAN_ERR_CRTL | CAN_ERR_CNT, CAN_ERR_CRTL_TX_WARNING, 96, 3),
                  errorFrame(CAN_ERR_CRTL)};
  LONGS_EQUAL(96, port->status().txErrors.value());
  LONGS_EQUAL(3, port->status().rxErrors.value());
}

TEST(SocketCanPort, AnInterfaceThatGoesDownAndUpIsUsedAgain) {
  open();
  stateAfter(errorFrame(CAN_ERR_BUSOFF | CAN_ERR_CNT, 0, 255, 0));
  interfaceGoesDown();
  CHECK_FALSE(port->send(kFrame));
  CHECK_TRUE(port->status().state == CanState::kDown);
  CHECK_FALSE(port->status().txErrors.has_value());
  calls.flags = IFF_UP | IFF_RUNNING;
  CHECK_TRUE(port->status().state == CanState::kActive);
  CHECK_TRUE(port->send(kFrame));
}

TEST(SocketCanPort, WhatTheControllerSaidBeforeGoingDownIsForgotten) {
  open();
  interfaceGoesDown();
  calls.errors.push_back(errorFrame(CAN_ERR_BUSOFF | CAN_ERR_CNT, 0, 255, 0));
  CHECK_TRUE(port->status().state == CanState::kDown);
  calls.flags = IFF_UP | IFF_RUNNING;
  CHECK_TRUE(port->status().state == CanState::kActive);
  CHECK_FALSE(port->status().txErrors.has_value());
}

TEST(SocketCanPort, ARemovedInterfaceIsOpenedAgainWhenItComesBack) {
  open();
  interfaceIsRemoved();
  CHECK_FALSE(port->receive().has_value());
  CHECK_FALSE(port->send(kFrame));
  CHECK_TRUE(port->status().state == CanState::kDown);
  LONGS_EQUAL(0, calls.openSockets());
  calls.indexResult = 0;
  calls.frames = {dataFrame(0x222)};
  LONGS_EQUAL(0x222, port->receive().value().id);
  CHECK_TRUE(port->send(kFrame));
  LONGS_EQUAL(2, calls.openSockets());
}

TEST(SocketCanPort, APortThatOnlyReceivesOpensAReturnedInterfaceToo) {
  open();
  interfaceIsRemoved();
  CHECK_FALSE(port->receive().has_value());
  LONGS_EQUAL(0, calls.openSockets());
  calls.indexResult = 0;
  calls.frames = {dataFrame(0x222)};
  LONGS_EQUAL(0x222, port->receive().value().id);
}

TEST(SocketCanPort, AnInterruptedReadOfTheStateIsRepeated) {
  open();
  calls.errors = {{.result = -EINTR}, errorFrame(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE)};
  CHECK_TRUE(port->status().state == CanState::kPassive);
}

TEST(SocketCanPort, AReceivedFrameHasItsDataAndZeroBeyond) {
  open();
  auto read = dataFrame(0x7FF, 2);
  for (std::uint8_t& byte : read.frame.data) byte = 0xEE;
  calls.frames = {read};
  CHECK_TRUE(port->receive() == (CanFrame{.id = 0x7FF, .length = 2, .data = {0xEE, 0xEE}}));
  CHECK_FALSE(port->receive().has_value());
}

TEST(SocketCanPort, FramesOfOtherKindsAreSkippedAndCounted) {
  open();
  calls.frames = {dataFrame(0x123 | CAN_EFF_FLAG),
                  dataFrame(0x123 | CAN_RTR_FLAG),
                  errorFrame(CAN_ERR_BUSOFF),
                  dataFrame(0x800),
                  dataFrame(0x123, 9),
                  dataFrame(0x124)};
  LONGS_EQUAL(0x124, port->receive().value().id);
  LONGS_EQUAL(5, port->status().missed);
  CHECK_TRUE(port->status().state == CanState::kActive);
}

TEST(SocketCanPort, ATapGetsFramesOfOtherFormatsInTheirOrder) {
  open();
  std::string heard;
  port->hearOthers([&](const can::OtherFrame& other) {
    const std::string line = can::formatLogLine(other.time_ns / 1000, "c", other.frame, other.isRemote);
    heard += line.substr(line.find("c ") + 2) + " ";
  });
  auto fd = dataFrame(0x123, 9);
  fd.result = CANFD_MTU;
  fd.frame.flags = CANFD_BRS;
  calls.frames = {dataFrame(0x123 | CAN_EFF_FLAG, 1), dataFrame(0x123 | CAN_RTR_FLAG, 2), fd,
                  dataFrame(0x124), dataFrame(0x7 | CAN_EFF_FLAG | CAN_RTR_FLAG)};
  LONGS_EQUAL(0x124, port->receive().value().id);
  STRCMP_EQUAL("00000123#00 123#R2 123##1000000000000000000 ", heard.c_str());
  CHECK_FALSE(port->receive().has_value());
  STRCMP_CONTAINS(" 00000007#R ", heard.c_str());
  LONGS_EQUAL(0, port->status().missed);
}

TEST(SocketCanPort, TheKernelIsAskedForFramesOfOtherFormatsWhileThereIsATap) {
  open();
  port->hearOthers([](const can::OtherFrame&) {});
  LONGS_EQUAL(0, calls.filters.at(0).can_mask);
  interfaceIsRemoved();
  port->status();
  calls.indexResult = 0;
  port->status();
  LONGS_EQUAL(0, calls.filters.at(0).can_mask);
  port->hearOthers({});
  LONGS_EQUAL(CAN_EFF_FLAG | CAN_RTR_FLAG, calls.filters.at(0).can_mask);
}

TEST(SocketCanPort, AShortReadIsSkippedAndCounted) {
  open();
  calls.frames = {{.result = sizeof(can_frame) - 1}, {.result = 0}, dataFrame(0x124)};
  LONGS_EQUAL(0x124, port->receive().value().id);
  LONGS_EQUAL(2, port->status().missed);
}

TEST(SocketCanPort, AnInterruptedReadIsRepeated) {
  open();
  calls.frames = {{.result = -EINTR}, dataFrame(0x124)};
  LONGS_EQUAL(0x124, port->receive().value().id);
  LONGS_EQUAL(0, port->status().missed);
}

TEST(SocketCanPort, WhatWaitedWhenTheInterfaceWentDownIsStillReceived) {
  open();
  interfaceGoesDown();
  calls.frames.push_back(dataFrame(0x124));
  CHECK_FALSE(port->receive().has_value());
  LONGS_EQUAL(0x124, port->receive().value().id);
}

TEST(SocketCanPort, FramesLostByKernelAndControllerAreCountedAcrossReopening) {
  open();
  auto read = dataFrame(0x124);
  read.lost = 12;
  calls.frames = {read};
  port->receive();
  calls.errors = {errorFrame(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW)};
  LONGS_EQUAL(13, port->status().missed);
  interfaceIsRemoved();
  port->status();
  calls.indexResult = 0;
  read.lost = 2;
  calls.frames = {read};
  port->receive();
  LONGS_EQUAL(15, port->status().missed);
}

TEST(SocketCanPort, ATransmissionTimeoutIsADroppedFrame) {
  open();
  calls.errors = {errorFrame(CAN_ERR_TX_TIMEOUT), errorFrame(CAN_ERR_TX_TIMEOUT)};
  LONGS_EQUAL(2, port->status().dropped);
}

TEST(SocketCanPort, AFloodOfJunkDoesNotHoldTheCaller) {
  open();
  calls.frames.assign(1000, dataFrame(0x123 | CAN_EFF_FLAG));
  calls.errors.assign(1000, errorFrame(CAN_ERR_CNT));
  CHECK_FALSE(port->receive().has_value());
  CHECK_TRUE(port->send(kFrame));
  CHECK_TRUE(calls.frames.size() > 700 && calls.errors.size() > 700);
}

TEST(SocketCanPort, WaitingTellsWhetherSomethingCame) {
  open();
  for (const int nothing : {0, -EINTR}) {
    calls.pollResult = nothing;
    CHECK_FALSE(port->waitReadable(std::chrono::milliseconds(1)));
  }
  calls.pollResult = 1;
  CHECK_TRUE(port->waitReadable(std::chrono::milliseconds(1)));
}
