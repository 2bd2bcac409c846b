#include "host/can/udp_port.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "host/base/failure.hpp"
#include "tests/hal/can_port_contract.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace std::chrono_literals;
using can::BusFilter;
using can::UdpPort;

namespace {

/// A bus of this test run's own: others may run beside it.
std::string ownBus() { return "udp:" + std::to_string(20000 + getpid() % 40000); }

std::optional<can::TimedFrame> hearTimed(UdpPort& port) {
  port.waitReadable(2s);
  return port.receiveTimed();
}

std::optional<CanFrame> hear(UdpPort& port) {
  const auto timed = hearTimed(port);
  if (!timed) return std::nullopt;
  return timed->frame;
}

/// What the contract asks for, but for a bus that can be blocked: this one can't.
class UdpBench {
 public:
  UdpPort& port() { return port_; }
  bool otherSends(const CanFrame& frame) { return other_.send(frame); }
  std::optional<CanFrame> otherHears() { return hear(other_); }
  std::optional<CanFrame> portHears() { return hear(port_); }
  void block() {}
  void unblock() {}

 private:
  UdpPort port_{ownBus()};
  UdpPort other_{ownBus()};
};

/// Sends bytes as they are, as another program might.
void sendRaw(const std::string& bus, const std::vector<std::uint8_t>& bytes) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(bus.substr(4))));
  inet_pton(AF_INET, "239.255.67.65", &to.sin_addr);
  in_addr loopback{};
  inet_pton(AF_INET, "127.0.0.1", &loopback);
  setsockopt(socket, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback);
  sendto(socket, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof to);
  close(socket);
}

}  // namespace

TEST_GROUP(UdpPort) {
  static constexpr CanFrame kFrame{.id = 0x181, .length = 2, .data = {0xAB, 0xCD}};
  contract::CanPortContract<UdpBench> contract;

  static void refused(const std::string& name, ExitCode code, const char* message) {
    try {
      UdpPort port(name);
    } catch (const Failure& failure) {
      CHECK_TRUE(failure.code() == code);
      STRCMP_CONTAINS(message, failure.what());
      return;
    }
    FAIL("opened");
  }
};

TEST(UdpPort, OthersHearWhatIsSentInOrder) { contract.othersHearWhatIsSentInOrder(); }
TEST(UdpPort, FramesOfOthersAreReceivedInOrderOfArrival) {
  contract.framesOfOthersAreReceivedInOrderOfArrival();
}
TEST(UdpPort, ItsOwnFramesAreNotReceived) { contract.itsOwnFramesAreNotReceived(); }
TEST(UdpPort, NothingNewIsNothing) { contract.nothingNewIsNothing(); }
TEST(UdpPort, DataBeyondTheLengthArriveAsZero) { contract.dataBeyondTheLengthArriveAsZero(); }
TEST(UdpPort, AFrameNoBusCanCarryIsRefused) { contract.aFrameNoBusCanCarryIsRefused(); }
TEST(UdpPort, AWorkingBusIsActiveAndLosesNothing) { contract.aWorkingBusIsActiveAndLosesNothing(); }

TEST(UdpPort, ADatagramIsAsItsPageSays) {
  const std::vector<std::uint8_t> bytes{1, 0x01, 0x81, 2, 0xAB, 0xCD};
  CHECK_TRUE(can::toDatagram(kFrame) == bytes);
  CHECK_TRUE(can::fromDatagram(bytes) == kFrame);
}

TEST(UdpPort, EveryNodeHearsEveryOther) {
  UdpPort a(ownBus()), b(ownBus()), c(ownBus());
  CHECK_TRUE(b.send(kFrame));
  CHECK_TRUE(hear(a) == kFrame);
  CHECK_TRUE(hear(c) == kFrame);
  CHECK_FALSE(b.receive().has_value());
}

TEST(UdpPort, ANodeOnItsOwnCanSpeak) { CHECK_TRUE(UdpPort(ownBus()).send(kFrame)); }

TEST(UdpPort, AnotherBusIsNotHeard) {
  UdpPort here(ownBus()), elsewhere("udp:19999"), other(ownBus());
  elsewhere.send({.id = 0x555});
  other.send(kFrame);
  CHECK_TRUE(hear(here) == kFrame);
  CHECK_FALSE(here.receive().has_value());
}

TEST(UdpPort, AFrameComesWithTheTimeOfItsArrival) {
  // Linux switches its time stamps on in the background once a socket asks for them, late on a busy machine;
  // until then a frame has the time at which it is read (net_enable_timestamp() in net/core/dev.c).
  constexpr int kMostTries = 200;
  constexpr std::int64_t kUnread_ns = 20'000'000;
  const auto now_ns = [] {
    return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
  };
  UdpPort port(ownBus()), other(ownBus());
  bool isOfArrival = false;
  for (int i = 0; i < kMostTries && !isOfArrival; ++i) {
    const auto before_ns = now_ns();
    other.send(kFrame);
    const auto after_ns = now_ns();
    std::this_thread::sleep_for(std::chrono::nanoseconds(kUnread_ns));
    const auto heard = hearTimed(port);
    CHECK_TRUE(heard->time_ns >= before_ns - 1'000'000);
    isOfArrival = heard->time_ns <= after_ns + kUnread_ns / 2;
  }
  CHECK_TRUE(isOfArrival);
}

TEST(UdpPort, AFilterLeavesOutOtherIdentifiers) {
  UdpPort port(ownBus(), BusFilter{.id = 0x601, .mask = 0x7FF}), other(ownBus());
  for (const int id : {0x600, 0x602, 0x201, 0x601, 0x001})
    other.send({.id = static_cast<std::uint16_t>(id), .length = 0});
  LONGS_EQUAL(0x601, hear(port)->id);
  CHECK_FALSE(port.receive().has_value());
  LONGS_EQUAL(0, port.malformed());
}

TEST(UdpPort, WhatAFilterLeavesOutIsNotMissed) {
  UdpPort port(ownBus(), BusFilter{.id = 0x601, .mask = 0x7FF}), other(ownBus());
  for (int i = 0; i < 100; ++i) other.send(kFrame);
  other.send({.id = 0x601});
  CHECK_TRUE(hear(port).has_value());
  LONGS_EQUAL(0, port.status().missed);
}

TEST(UdpPort, ItsOwnFramesAreNotMissed) {
  UdpPort port(ownBus()), other(ownBus());
  for (int i = 0; i < 100; ++i) port.send(kFrame);
  other.send(kFrame);
  CHECK_TRUE(hear(port).has_value());
  LONGS_EQUAL(0, port.status().missed);
}

TEST(UdpPort, MalformedDatagramsAreCountedAndIgnored) {
  UdpPort port(ownBus()), other(ownBus());
  const std::vector<std::vector<std::uint8_t>> malformed{
      {},
      {1},
      {1, 0x01, 0x81},
      {2, 0x01, 0x81, 0},                              // another version
      {1, 0x08, 0x00, 0},                              // an identifier of 12 bits
      {1, 0x01, 0x81, 9, 1, 2, 3, 4, 5, 6, 7, 8, 9},   // nine bytes
      {1, 0x01, 0x81, 2, 1},                           // too short for its length
      {1, 0x01, 0x81, 8, 1, 2, 3, 4, 5, 6, 7, 8, 9}};  // too long for it
  for (const auto& bytes : malformed) sendRaw(ownBus(), bytes);
  sendRaw(ownBus(), std::vector<std::uint8_t>(2000, 1));
  other.send(kFrame);
  CHECK_TRUE(hear(port) == kFrame);
  LONGS_EQUAL(malformed.size() + 1, port.malformed());
  LONGS_EQUAL(0, port.status().missed);
}

TEST(UdpPort, AFloodOfJunkDoesNotHoldTheCaller) {
  UdpPort port(ownBus());
  for (int i = 0; i < 100; ++i) sendRaw(ownBus(), {0});
  CHECK_FALSE(port.receive().has_value());
  CHECK_TRUE(port.malformed() < 100);
}

TEST(UdpPort, ASlowReaderKnowsWhatItMissed) {
  constexpr int kFrames = 20'000;  // more than the receive buffer that a port asks for
  UdpPort port(ownBus()), other(ownBus());
  for (int i = 0; i < kFrames; ++i) other.send(kFrame);
  int heard = 0;
  while (port.receive()) ++heard;
  other.send(kFrame);  // the kernel tells with the next one
  CHECK_TRUE(hear(port).has_value());
  CHECK_TRUE(port.status().missed > 0);
  LONGS_EQUAL(kFrames, heard + static_cast<int>(port.status().missed));
}

TEST(UdpPort, WaitingEndsWithoutAFrame) {
  UdpPort port(ownBus());
  CHECK_FALSE(port.waitReadable(1ms));
  CHECK_TRUE(port.send(kFrame));
  CHECK_FALSE(port.waitReadable(1ms));  // its own doesn't wake it
}

TEST(UdpPort, ANameThatIsNoneIsRefused) {
  for (const std::string name :
       {"udp:", "udp:x", "udp:80", "udp:65536", "udp:29536x", "udp:-1", "", "ud", "xyz:2000"})
    refused(name, ExitCode::kUsage, (name + " is no bus: udp, or udp:PORT").c_str());
  CHECK_TRUE(can::isUdpName("udp") && can::isUdpName("udp:1"));
  CHECK_FALSE(can::isUdpName("udp0") || can::isUdpName("can0") || can::isUdpName(""));
}

TEST(UdpPort, ASilentFingerMayNotRunOrHaveAnotherNumber) {
  UdpPort port(ownBus());
  STRCMP_CONTAINS(("`strainfinger run --can " + ownBus() + " -c FINGER.toml`; can.node").c_str(),
                  port.hints().whenSilent.c_str());
}

TEST(UdpPort, WhereThereAreNoSocketsItSaysSo) {
  rlimit before{};
  getrlimit(RLIMIT_NOFILE, &before);
  const int open = dup(0);
  close(open);
  const rlimit none{static_cast<rlim_t>(open), before.rlim_max}, one{none.rlim_cur + 1, before.rlim_max};
  for (const rlimit& limit : {none, one}) {
    setrlimit(RLIMIT_NOFILE, &limit);
    refused("udp", ExitCode::kNoInterface, "cannot open a bus on UDP: socket: Too many open files");
  }
  setrlimit(RLIMIT_NOFILE, &before);
  const int next = dup(0);
  LONGS_EQUAL(open, next);  // nothing was left open
  close(next);
}
