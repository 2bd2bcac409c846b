#pragma once
// A bus between the programs of this machine, without a CAN interface: UDP_BUS.md has the datagrams.

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/can/bus_port.hpp"

namespace strainfinger::can {

/// "udp" or "udp:...", which is no name that an interface would have.
bool isUdpName(std::string_view name);

/// The frame as a datagram, and back; nothing if the datagram is none.
std::vector<std::uint8_t> toDatagram(const CanFrame& frame);
std::optional<CanFrame> fromDatagram(std::span<const std::uint8_t> datagram);

/// A node of the bus. Every port of this name hears all the others; frames of one port stay in order.
/// A bus without errors or bit rate: send() always takes a valid frame, whether or not somebody listens; a
/// receiver that is too slow loses frames and counts them as missed, if it has no filter: with one it counts
/// none, as the kernel doesn't tell what was lost from what was left out. Costs a system call a frame.
class UdpPort final : public BusPort {
 public:
  static constexpr std::uint16_t kDefaultPort = 29536;

  /// `name`: "udp", or "udp:PORT" for another bus, PORT from 1024 to 65535. Throws Failure(kUsage) for
  /// another name, Failure(kNoInterface) when the system has no such sockets.
  explicit UdpPort(std::string name, BusFilter filter = {});
  ~UdpPort() override;

  bool send(const CanFrame& frame) noexcept override;
  std::optional<TimedFrame> receiveTimed() noexcept override;
  hal::CanStatus status() noexcept override;
  bool waitReadable(std::chrono::milliseconds timeout) noexcept override;
  int descriptor() const noexcept override { return hears_; }
  BusHints hints() const override;
  const std::string& name() const noexcept override { return name_; }
  std::uint32_t malformed() const noexcept override { return malformed_; }

 private:
  void open(BusFilter filter);
  void close() noexcept;
  /// Takes the oldest datagram away if it is this port's own; false: it isn't.
  bool passOverOwn() noexcept;

  std::string name_;
  std::uint16_t port_;
  int hears_ = -1;   ///< socket of the group's datagrams
  int speaks_ = -1;  ///< socket whose port tells our own datagrams from others'
  std::uint16_t ownPort_ = 0;
  bool hearsAll_ = true;
  std::uint32_t missed_ = 0;
  std::uint32_t malformed_ = 0;
};

static_assert(hal::CanPort<UdpPort>);

}  // namespace strainfinger::can
