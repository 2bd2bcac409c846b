#pragma once
// A node on a live bus, whatever carries the bus.

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "hal/can_port.hpp"
#include "host/can/other_frame.hpp"

namespace strainfinger::can {

/// A frame and when it arrived, in nanoseconds since 1970.
struct TimedFrame {
  std::int64_t time_ns = 0;
  CanFrame frame;
};

/// What a port hears of the bus: frames whose identifier agrees with `id` in the bits of `mask`. What it
/// doesn't hear costs it nothing and is not missed.
struct BusFilter {
  std::uint16_t id = 0;
  std::uint16_t mask = 0;  ///< 0: everything
};

/// Parts of messages: what may be wrong with a bus of this kind, and the command that shows or mends it.
struct BusHints {
  std::string whenBlocked;  ///< it takes no frames
  std::string whenSilent;   ///< a finger that should be on it is not heard
};

/// A hal::CanPort that can be waited for. A frame of its own never comes back to it.
class BusPort {
 public:
  BusPort() = default;
  virtual ~BusPort() = default;
  BusPort(const BusPort&) = delete;
  BusPort& operator=(const BusPort&) = delete;

  virtual bool send(const CanFrame& frame) noexcept = 0;
  /// The oldest frame not fetched yet; never blocks.
  virtual std::optional<TimedFrame> receiveTimed() noexcept = 0;
  virtual hal::CanStatus status() noexcept = 0;

  std::optional<CanFrame> receive() noexcept {
    const auto timed = receiveTimed();
    if (!timed) return std::nullopt;
    return timed->frame;
  }

  /// How long to wait between a frame's arrival and reading, so that the frames that come meanwhile cost one
  /// awakening for all: at 9,000 frames a second, the most that 1 Mbit/s has, 45 of the hundreds that a
  /// socket holds.
  static constexpr std::chrono::milliseconds kGather{5};

  /// Sleeps until a frame has arrived (or the bus' state has changed), at most so long; false: nothing came.
  virtual bool waitReadable(std::chrono::milliseconds timeout) noexcept = 0;
  /// For poll(): readable when waitReadable() would return. Ask anew before each poll: it changes when an
  /// interface goes and comes back, and is -1 (which poll() passes over) while that is gone.
  virtual int descriptor() const noexcept = 0;
  /// As it was opened: "can0", "udp".
  virtual const std::string& name() const noexcept = 0;
  virtual BusHints hints() const = 0;
  using OtherTap = std::function<void(const OtherFrame&)>;
  /// From now on receiveTimed() gives the frames of other formats that it comes past to `tap`, in the order
  /// of the bus; without a tap, and by a port with a BusFilter, they are not heard. Some buses have none.
  virtual void hearOthers(OtherTap /*tap*/) noexcept {}
  /// What came over the bus and was no frame, since start.
  virtual std::uint32_t malformed() const noexcept { return 0; }
};

static_assert(hal::CanPort<BusPort>);

}  // namespace strainfinger::can
