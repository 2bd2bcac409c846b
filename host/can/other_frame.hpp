#pragma once
// Frames on a bus that no finger sends or takes, and CanFrame can't hold.

#include <cstdint>

#include "host/can/candump_text.hpp"

namespace strainfinger::can {

/// A frame of a 29-bit identifier, a remote frame or one of CAN FD.
struct OtherFrame {
  std::int64_t time_ns = 0;  ///< since 1970, when it arrived
  bool isRemote = false;     ///< then `frame.length` is what it asks for, without data
  LoggedFrame frame;
};

/// Bits on the bus, as of a CanFrame: without stuff bits, with the space to the next frame (ISO 11898-1). Of
/// an FD frame that changes the bit rate only those before and behind that: by how much isn't known here.
constexpr std::uint32_t unstuffedBits(const OtherFrame& other) {
  constexpr std::uint8_t kRateSwitch = 1;
  const LoggedFrame& frame = other.frame;
  if (!frame.fd)
    return strainfinger::unstuffedBits(other.isRemote ? 0U : frame.length) + (frame.extended ? 20U : 0U);
  const std::uint32_t outer = frame.extended ? 49 : 30;
  if (frame.fdFlags & kRateSwitch) return outer;
  return outer + 9 + 8U * frame.length + (frame.length > 16 ? 21U : 17U);
}

}  // namespace strainfinger::can
