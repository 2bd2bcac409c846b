#pragma once
// A CAN port that does what the test says.

#include <cstdint>
#include <deque>
#include <vector>

#include "hal/can_port.hpp"

namespace strainfinger::doubles {

class FakeCanPort {
 public:
  hal::CanStatus bus{.state =
                         hal::CanState::kActive};  ///< what status() says; bus-off and down refuse frames
  bool busy = false;                               ///< the mailboxes are full
  std::size_t room = SIZE_MAX;                     ///< free mailboxes; every frame takes one for good
  std::vector<CanFrame> sent;                      ///< what send() took

  /// Another node's frame arrives.
  void deliver(const CanFrame& frame) { arrived_.push_back(asReceived(frame)); }

  bool send(const CanFrame& frame) noexcept {
    const bool open = bus.state != hal::CanState::kBusOff && bus.state != hal::CanState::kDown;
    if (busy || room == 0 || !open || !isValid(frame)) return false;
    --room;
    sent.push_back(asReceived(frame));
    return true;
  }

  std::optional<CanFrame> receive() noexcept {
    if (arrived_.empty()) return std::nullopt;
    const CanFrame frame = arrived_.front();
    arrived_.pop_front();
    return frame;
  }

  hal::CanStatus status() const noexcept { return bus; }

 private:
  std::deque<CanFrame> arrived_;
};

static_assert(hal::CanPort<FakeCanPort>);

}  // namespace strainfinger::doubles
