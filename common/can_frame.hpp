#pragma once
// A classic CAN frame with an 11-bit identifier: what hal/can_port.hpp carries and frames.hpp fills.

#include <array>
#include <cstddef>
#include <cstdint>

namespace strainfinger {

struct CanFrame {
  std::uint16_t id = 0;     ///< 0 .. 0x7FF, no flag bits
  std::uint8_t length = 0;  ///< bytes of data in use, 0 .. 8
  std::array<std::uint8_t, 8> data{};
  bool operator==(const CanFrame&) const = default;
};

inline constexpr std::uint16_t kMaxCanId = 0x7FF;

/// Bits on the bus of a frame with so many bytes of data and of the space to the next one, stuff bits apart
/// (ISO 11898-1).
constexpr std::uint32_t unstuffedBits(std::uint32_t length) { return 47 + 8 * length; }

/// Whether a bus can carry it.
constexpr bool isValid(const CanFrame& frame) {
  return frame.id <= kMaxCanId && frame.length <= frame.data.size();
}

/// As a receiver gets it: data beyond the length are zero.
constexpr CanFrame asReceived(CanFrame frame) {
  for (std::size_t i = frame.length; i < frame.data.size(); ++i) frame.data[i] = 0;
  return frame;
}

}  // namespace strainfinger
