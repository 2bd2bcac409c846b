// SocketCanPort on a real vcan0, with can-utils and iproute2 as the other side. Runs as root of its own
// network.

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include "host/base/failure.hpp"
#include "host/can/socketcan_port.hpp"
#include "tests/hal/can_port_contract.hpp"

using namespace strainfinger;
using can::SocketCanPort;
using hal::CanState;
using namespace std::chrono_literals;

namespace {

void execute(const std::string& command) {
  LONGS_EQUAL_TEXT(0, std::system(command.c_str()), command.c_str());
}

std::optional<CanFrame> receiveWithin(SocketCanPort& port, std::chrono::milliseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  do {
    if (const auto frame = port.receive()) return frame;
    port.waitReadable(10ms);
  } while (std::chrono::steady_clock::now() < end);
  return std::nullopt;
}

class SocketCanBench {
 public:
  SocketCanPort& port() { return port_; }
  bool otherSends(const CanFrame& frame) { return other_.send(frame); }
  std::optional<CanFrame> otherHears() { return receiveWithin(other_, 2s); }
  std::optional<CanFrame> portHears() { return receiveWithin(port_, 2s); }
  void block() { execute("ip link set vcan0 down"); }
  void unblock() { execute("ip link set vcan0 up"); }

 private:
  SocketCanPort port_{"vcan0"};
  SocketCanPort other_{"vcan0"};
};

/// candump beside us: what it prints of the next frames, a line each.
class Candump {
 public:
  explicit Candump(int frames) : output_(popen(command(frames).c_str(), "r"), pclose) {
    while (std::system("grep -q vcan0 /proc/net/can/rcvlist_all") != 0) std::this_thread::sleep_for(10ms);
  }

  /// The rest of a line of `candump -L` behind the time: "vcan0 123#DEADBEEF".
  std::string line() {
    std::array<char, 256> text{};
    if (!std::fgets(text.data(), text.size(), output_.get())) return "nothing";
    const std::string all(text.data());
    return all.substr(all.find(") ") + 2, all.size() - all.find(") ") - 3);
  }

 private:
  static std::string command(int frames) {
    return "candump -L -T 5000 -n " + std::to_string(frames) + " vcan0";
  }
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> output_;
};

}  // namespace

CAN_PORT_CONTRACT(SocketCan, SocketCanBench)

TEST_GROUP(SocketCan) {
  static constexpr CanFrame kFrame{.id = 0x181, .length = 2, .data = {0xAB, 0xCD}};
  SocketCanPort port{"vcan0"};

  bool isTakenWithin(std::chrono::milliseconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    while (std::chrono::steady_clock::now() < end) {
      if (port.send(kFrame)) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }

  std::string openingMessage(const std::string& interface) {
    try {
      SocketCanPort other(interface);
    } catch (const Failure& failure) {
      LONGS_EQUAL(3, static_cast<int>(failure.code()));
      return failure.what();
    }
    return "opened";
  }

  CanState stateAfter(const std::string& errorFrame) {
    execute("cansend vcan0 " + errorFrame);
    return port.status().state;
  }
};

TEST(SocketCan, CandumpSeesWhatIsSentByteForByte) {
  Candump candump(4);
  CHECK_TRUE(port.send({.id = 0x000}));
  CHECK_TRUE(port.send({.id = 0x123, .length = 4, .data = {0xDE, 0xAD, 0xBE, 0xEF, 0x99}}));
  CHECK_TRUE(port.send({.id = 0x7FF, .length = 8, .data = {0, 1, 2, 3, 4, 5, 6, 0xFF}}));
  CHECK_TRUE(port.send({.id = 0x181, .length = 1, .data = {0}}));
  STRCMP_EQUAL("vcan0 000#", candump.line().c_str());
  STRCMP_EQUAL("vcan0 123#DEADBEEF", candump.line().c_str());
  STRCMP_EQUAL("vcan0 7FF#00010203040506FF", candump.line().c_str());
  STRCMP_EQUAL("vcan0 181#00", candump.line().c_str());
}

TEST(SocketCan, FramesOfCansendAreReceived) {
  execute("cansend vcan0 123#DEADBEEF; cansend vcan0 7FF#; cansend vcan0 000#0011223344556677");
  CHECK_TRUE(receiveWithin(port, 2s) ==
             (CanFrame{.id = 0x123, .length = 4, .data = {0xDE, 0xAD, 0xBE, 0xEF}}));
  CHECK_TRUE(receiveWithin(port, 2s) == CanFrame{.id = 0x7FF});
  CHECK_TRUE(receiveWithin(port, 2s) ==
             (CanFrame{.id = 0, .length = 8, .data = {0x00, 0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77}}));
}

TEST(SocketCan, ExtendedRemoteFdAndErrorFramesAreNotReceived) {
  execute(
      "cansend vcan0 00000123#11; cansend vcan0 123#R; cansend vcan0 123##111; cansend vcan0 "
      "20000004#0000000000000000");
  execute("cansend vcan0 124#22");
  CHECK_TRUE(receiveWithin(port, 2s) == (CanFrame{.id = 0x124, .length = 1, .data = {0x22}}));
  LONGS_EQUAL(0, port.status().missed);
}

TEST(SocketCan, ErrorFramesSetTheStateAndTheCounters) {
  CHECK_TRUE(stateAfter("20000204#0008000000006000") == CanState::kWarning);
  LONGS_EQUAL(0x60, port.status().txErrors.value());
  LONGS_EQUAL(0, port.status().rxErrors.value());
  CHECK_TRUE(stateAfter("20000204#0020000000008007") == CanState::kPassive);
  LONGS_EQUAL(0x80, port.status().txErrors.value());
  LONGS_EQUAL(7, port.status().rxErrors.value());
  CHECK_TRUE(stateAfter("20000004#0040000000000000") == CanState::kActive);
}

TEST(SocketCan, BusOffRefusesFramesUntilTheRestart) {
  CHECK_TRUE(stateAfter("20000040#0000000000000000") == CanState::kBusOff);
  CHECK_FALSE(port.send(kFrame));
  CHECK_TRUE(stateAfter("20000100#0000000000000000") == CanState::kActive);
  CHECK_TRUE(port.send(kFrame));
}

TEST(SocketCan, AnInterfaceThatIsDownRefusesAndIsUsedAgainWhenUp) {
  execute("ip link set vcan0 down");
  CHECK_FALSE(port.send(kFrame));
  CHECK_TRUE(port.status().state == CanState::kDown);
  execute("ip link set vcan0 up");
  CHECK_TRUE(port.status().state == CanState::kActive);
  CHECK_TRUE(isTakenWithin(2s));
}

TEST(SocketCan, ARemovedInterfaceIsUsedAgainWhenItComesBack) {
  execute("ip link del vcan0");
  CHECK_FALSE(port.send(kFrame));
  CHECK_FALSE(port.receive().has_value());
  CHECK_TRUE(port.status().state == CanState::kDown);
  execute("ip link add dev vcan0 type vcan; ip link set vcan0 up");
  CHECK_TRUE(isTakenWithin(2s));
  execute("cansend vcan0 124#22");
  LONGS_EQUAL(0x124, receiveWithin(port, 2s).value().id);
}

TEST(SocketCan, AMissingInterfaceIsNamedWithTheCommandThatMakesIt) {
  STRCMP_EQUAL(
      "no CAN interface vcan7: make it with `sudo ip link add dev vcan7 type vcan && sudo ip link set vcan7 "
      "up`",
      openingMessage("vcan7").c_str());
  execute("ip link add dev vcan7 type vcan && ip link set vcan7 up");
  STRCMP_EQUAL("opened", openingMessage("vcan7").c_str());
  execute("ip link del vcan7");
}

TEST(SocketCan, AnInterfaceThatIsDownIsNamedWithTheCommandThatBringsItUp) {
  execute("ip link set vcan0 down");
  STRCMP_EQUAL("CAN interface vcan0 is down: bring it up with `sudo ip link set vcan0 up`",
               openingMessage("vcan0").c_str());
  execute("ip link set vcan0 up");
  STRCMP_EQUAL("opened", openingMessage("vcan0").c_str());
}

TEST(SocketCan, AnInterfaceThatIsNotCanIsTold) {
  STRCMP_CONTAINS("lo is not a CAN interface", openingMessage("lo").c_str());
}

TEST(SocketCan, FramesTheKernelHasNoRoomForAreCounted) {
  constexpr int kFrames = 3000;
  SocketCanPort sender("vcan0");
  for (int i = 0; i < kFrames; ++i) CHECK_TRUE(sender.send(kFrame));
  int received = 0;
  while (port.receive()) ++received;
  CHECK_TRUE(sender.send(kFrame));  // the kernel tells with the next frame
  CHECK_TRUE(receiveWithin(port, 2s).has_value());
  CHECK_TRUE(port.status().missed > 0);
  LONGS_EQUAL(kFrames, received + static_cast<int>(port.status().missed));
}

TEST(SocketCan, ABlockedBusRefusesFramesAfterAHandfulAndKeepsTheirOrder) {
  SocketCanPort listener("vcan0");
  execute("tc qdisc add dev vcan0 root plug limit 1000000; tc qdisc change dev vcan0 root plug block");
  int taken = 0;
  while (taken < 100 && port.send({.id = 0x181, .length = 1, .data = {static_cast<std::uint8_t>(taken)}}))
    ++taken;
  CHECK_TRUE(taken >= 1 && taken <= 16);
  execute("tc qdisc change dev vcan0 root plug release_indefinite");
  for (int i = 0; i < taken; ++i) LONGS_EQUAL(i, receiveWithin(listener, 2s).value().data[0]);
  CHECK_TRUE(isTakenWithin(2s));
}

TEST(SocketCan, AFullQueueRefusesTheFrame) {
  execute("tc qdisc add dev vcan0 root plug limit 20; tc qdisc change dev vcan0 root plug block");
  CHECK_TRUE(port.send(kFrame));
  CHECK_FALSE(port.send(kFrame));
  execute("tc qdisc change dev vcan0 root plug release_indefinite");
  CHECK_TRUE(isTakenWithin(2s));
}
