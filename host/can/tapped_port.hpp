#pragma once
// A CAN port whose sent frames can be looked at.

#include <utility>
#include <vector>

#include "hal/can_port.hpp"

namespace strainfinger::can {

/// Passes everything on to `port`, which must outlive it, and keeps what it took until that is fetched.
template <hal::CanPort Port>
class TappedPort {
 public:
  explicit TappedPort(Port& port) : port_(port) {}

  bool send(const CanFrame& frame) noexcept {
    const bool taken = port_.send(frame);
    if (taken) sent_.push_back(frame);
    return taken;
  }
  std::optional<CanFrame> receive() noexcept { return port_.receive(); }
  hal::CanStatus status() noexcept { return port_.status(); }

  /// What was sent since the last call, in order.
  std::vector<CanFrame> fetchSent() { return std::exchange(sent_, {}); }

 private:
  Port& port_;
  std::vector<CanFrame> sent_;
};

}  // namespace strainfinger::can
