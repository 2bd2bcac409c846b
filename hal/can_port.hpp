#pragma once
// A CAN controller, as the firmware sees it.

#include <concepts>
#include <cstdint>
#include <optional>

#include "common/can_frame.hpp"

namespace strainfinger::hal {

enum class CanState : std::uint8_t { kActive, kWarning, kPassive, kBusOff, kDown };

/// What a controller knows of the bus. Counters are ISO 11898's, 0..255; absent where a backend can't tell.
struct CanStatus {
  CanState state = CanState::kDown;
  std::optional<std::uint8_t> txErrors{};
  std::optional<std::uint8_t> rxErrors{};
  std::uint32_t dropped = 0;  ///< frames taken by send() that never reached the bus, since start
  std::uint32_t missed = 0;   ///< frames that arrived and were lost before receive(), since start
  /// Times the node left the bus since start. What send() had taken then and was not out yet is lost.
  std::uint32_t busOffs = 0;
};

/// Contract of a CAN port:
///  - `send(frame)` never blocks. True: the frame will go out, after every frame of the same identifier
///    taken before, unless a newer frame of its identifier replaces it while it waits, or it waits too long
///    (a backend may do that where what is old is worthless). False: not now (mailbox busy, bus off,
///    interface down); nothing was taken, the frame is the caller's to replace by a newer one. A failed write
///    is never reported as sent. A frame no bus can carry (isValid()) is never taken.
///  - `receive()` never blocks; frames of 11-bit identifiers only, data frames only, in order of arrival.
///    The port's own frames are not received. Data beyond a frame's length are zero.
///  - `status()` is cheap enough to be asked with every frame.
// clang-format off
template <typename T>
concept CanPort = requires(T port, const CanFrame& frame) {
  { port.send(frame) }
  noexcept->std::same_as<bool>;
  { port.receive() }
  noexcept->std::same_as<std::optional<CanFrame>>;
  { port.status() }
  noexcept->std::same_as<CanStatus>;
};
// clang-format on

}  // namespace strainfinger::hal
