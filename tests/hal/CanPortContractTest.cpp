#include "host/can/loopback_port.hpp"
#include "host/can/tapped_port.hpp"
#include "tests/doubles/fake_can_port.hpp"
#include "tests/hal/can_port_contract.hpp"

using namespace strainfinger;

namespace {

/// The other node doesn't read while the port is blocked: that is what blocks it.
class LoopbackBench {
 public:
  can::LoopbackPort& port() { return port_; }
  bool otherSends(const CanFrame& frame) { return other_.send(frame); }
  std::optional<CanFrame> otherHears() { return other_.receive(); }
  std::optional<CanFrame> portHears() { return port_.receive(); }
  void block() {
    for (std::size_t i = 0; i < can::LoopbackPort::kCapacity; ++i) port_.send({.id = 0x100});
  }
  void unblock() {
    while (other_.receive()) continue;
  }

 private:
  can::LoopbackBus bus_;
  can::LoopbackPort port_{bus_};
  can::LoopbackPort other_{bus_};
};

/// The loopback port again, seen through a tap.
class TappedBench : public LoopbackBench {
 public:
  can::TappedPort<can::LoopbackPort>& port() { return tapped_; }
  std::optional<CanFrame> portHears() { return tapped_.receive(); }

 private:
  can::TappedPort<can::LoopbackPort> tapped_{LoopbackBench::port()};
};

class FakeCanPortBench {
 public:
  doubles::FakeCanPort& port() { return port_; }
  bool otherSends(const CanFrame& frame) {
    port_.deliver(frame);
    return true;
  }
  std::optional<CanFrame> otherHears() {
    if (heard_ == port_.sent.size()) return std::nullopt;
    return port_.sent[heard_++];
  }
  std::optional<CanFrame> portHears() { return port_.receive(); }
  void block() { port_.busy = true; }
  void unblock() { port_.busy = false; }

 private:
  doubles::FakeCanPort port_;
  std::size_t heard_ = 0;
};

}  // namespace

CAN_PORT_CONTRACT(Loopback, LoopbackBench)
CAN_PORT_CONTRACT(Fake, FakeCanPortBench)
CAN_PORT_CONTRACT(Tapped, TappedBench)
