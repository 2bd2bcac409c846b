#pragma once
// A bus that tests speak on.

#include <chrono>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/frame_layout.hpp"
#include "host/can/bus_port.hpp"

namespace strainfinger::can {

/// Hears what it is given, and keeps what is sent.
class FakeBusPort : public BusPort {
 public:
  bool send(const CanFrame& frame) noexcept override {
    if (takes) sent.push_back(frame);
    if (takes && onSend) onSend(frame);
    return takes;
  }
  std::optional<TimedFrame> receiveTimed() noexcept override {
    for (; tap_ && !othersToHear.empty(); othersToHear.pop_front()) tap_(othersToHear.front());
    if (toHear.empty()) return std::nullopt;
    const TimedFrame frame = toHear.front();
    toHear.pop_front();
    return frame;
  }
  hal::CanStatus status() noexcept override {
    return {.state = busState, .missed = missed, .busOffs = timesAway};
  }
  bool waitReadable(std::chrono::milliseconds timeout) noexcept override {
    if (toHear.empty()) std::this_thread::sleep_for(timeout);
    return !toHear.empty();
  }
  int descriptor() const noexcept override { return -1; }
  BusHints hints() const override { return {.whenBlocked = "free it", .whenSilent = "start it"}; }
  const std::string& name() const noexcept override { return name_; }
  void hearOthers(OtherTap tap) noexcept override { tap_ = std::move(tap); }

  /// As a finger would say it now.
  template <typename Frame>
  void hear(const Frame& frame, std::uint8_t node = 1) {
    const auto sinceEpoch = std::chrono::system_clock::now().time_since_epoch();
    toHear.push_back({std::chrono::nanoseconds(sinceEpoch).count(), encode(frame, node)});
  }

  bool takes = true;
  hal::CanState busState = hal::CanState::kActive;
  std::uint32_t missed = 3;
  std::uint32_t timesAway = 0;
  std::deque<TimedFrame> toHear;
  std::deque<OtherFrame> othersToHear;  ///< before `toHear`
  std::vector<CanFrame> sent;
  std::function<void(const CanFrame&)> onSend;  ///< may hear() an answer

 private:
  std::string name_ = "fake0";
  OtherTap tap_;
};

}  // namespace strainfinger::can
