#pragma once
// Linux's CAN interfaces (SocketCAN) as a hal::CanPort.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "host/can/bus_port.hpp"
#include "host/can/socket_calls.hpp"

namespace strainfinger::can {

/// A CAN interface of this machine: can0, vcan0, slcan0.
///
/// State and counters come from the controller's error frames, which have a socket of their own; an interface
/// without a controller (vcan) is always active and has no counters. While the interface is down, bus-off or
/// gone, send() refuses; the port goes on by itself when the interface comes back, even a new one of the same
/// name. Frames that the kernel discards from its queue at bus-off or when the interface goes down are not in
/// `dropped`: it doesn't tell. The kernel's queue keeps the order of all frames, and holds only a handful of
/// this port's, so that what a blocked bus lets out later is not old. Costs two system calls a frame sent,
/// one a frame received. Frames of 29-bit identifiers, remote and FD frames reach it only while somebody has
/// hearOthers().
class SocketCanPort final : public BusPort {
 public:
  /// Throws Failure(kNoInterface) with the command that would help when there is no such CAN interface, it is
  /// down, or the kernel has no CAN. `bitrate` [bit/s] is for that command only: the interface's own is left
  /// alone.
  explicit SocketCanPort(std::string interface, int bitrate = 1'000'000, BusFilter filter = {},
                         SocketCalls& calls = linuxSocketCalls());
  ~SocketCanPort() override;

  bool send(const CanFrame& frame) noexcept override;
  std::optional<TimedFrame> receiveTimed() noexcept override;
  hal::CanStatus status() noexcept override;
  bool waitReadable(std::chrono::milliseconds timeout) noexcept override;
  int descriptor() const noexcept override { return frames_; }
  BusHints hints() const override;
  void hearOthers(OtherTap tap) noexcept override;
  const std::string& name() const noexcept override { return interface_; }

  std::uint32_t refused() const { return refused_; }  ///< frames send() did not take, since start

 private:
  int open() noexcept;
  void close() noexcept;
  void setFilter() noexcept;
  bool giveOther(int size, const canfd_frame& raw, std::int64_t time_ns) noexcept;
  void refresh() noexcept;
  void readErrorFrames() noexcept;
  void noteErrorFrame(const canfd_frame& frame) noexcept;
  void noteDown() noexcept;
  void noteFlags() noexcept;

  std::string interface_;
  BusFilter filter_;
  SocketCalls& calls_;
  OtherTap tap_;
  int frames_ = -1;  ///< socket of the data frames; -1 while the interface is gone
  int errors_ = -1;  ///< socket of the error frames
  std::uint32_t refused_ = 0;
  std::uint32_t lostInQueue_ = 0;    ///< by the present `frames_`, as the kernel counts
  std::uint32_t lostElsewhere_ = 0;  ///< by sockets closed since, by the controller, for their form
  hal::CanStatus status_;
};

static_assert(hal::CanPort<SocketCanPort>);

/// Brings an interface up that is down; `bitrate` [bit/s] where it has a controller.
std::string bringUpCommand(const std::string& interface, int bitrate);

}  // namespace strainfinger::can
