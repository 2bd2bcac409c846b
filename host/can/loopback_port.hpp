#pragma once
// A CAN bus inside this process, for machines without one.

#include <algorithm>
#include <deque>
#include <vector>

#include "hal/can_port.hpp"

namespace strainfinger::can {

class LoopbackPort;

/// What the ports of one bus share. It must outlive them. Not for several threads.
class LoopbackBus {
 private:
  friend class LoopbackPort;
  std::vector<LoopbackPort*> ports_;
};

/// One node of the bus: it hears all the others. A frame is on the bus for all of them or for none: send()
/// says "not now" while any of them has kCapacity frames unread. So nothing is ever lost, and whoever
/// attaches must read: a port attached for it and read each tick is how to watch the bus.
class LoopbackPort {
 public:
  static constexpr std::size_t kCapacity = 64;  ///< frames unread

  explicit LoopbackPort(LoopbackBus& bus) : bus_(bus) { bus_.ports_.push_back(this); }
  ~LoopbackPort() { std::erase(bus_.ports_, this); }
  LoopbackPort(const LoopbackPort&) = delete;
  LoopbackPort& operator=(const LoopbackPort&) = delete;

  bool send(const CanFrame& frame) noexcept {
    const auto full = [this](const LoopbackPort* port) {
      return port != this && port->unread_.size() == kCapacity;
    };
    if (!isValid(frame) || std::ranges::any_of(bus_.ports_, full)) return false;
    for (LoopbackPort* port : bus_.ports_)
      if (port != this) port->unread_.push_back(asReceived(frame));
    return true;
  }

  std::optional<CanFrame> receive() noexcept {
    if (unread_.empty()) return std::nullopt;
    const CanFrame frame = unread_.front();
    unread_.pop_front();
    return frame;
  }

  hal::CanStatus status() const noexcept {
    return {.state = hal::CanState::kActive, .txErrors = 0, .rxErrors = 0};
  }

 private:
  LoopbackBus& bus_;
  std::deque<CanFrame> unread_;
};

static_assert(hal::CanPort<LoopbackPort>);

}  // namespace strainfinger::can
