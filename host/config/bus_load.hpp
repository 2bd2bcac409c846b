#pragma once
// How many contacts a second a finger reports, and a bus can carry.

#include <cstdint>

#include "common/can_frame.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::config {

/// Bits on the bus of an 8-byte frame, stuffed at worst: a stuff bit for every 4 of the 34 + 8 n - 1 that are
/// subject to it.
inline constexpr int kWorstFrame_bits = unstuffedBits(8) + (34 + 8 * 8 - 1) / 4;
/// CONTACT, FORCE and PATCH; those of a second contact may wait.
inline constexpr int kFramesPerContact = 3;

/// The whole number that a finger is told: not more than is asked for.
constexpr std::uint16_t contactRate_hz(const Can& can) {
  return static_cast<std::uint16_t>(can.contact_rate_hz);
}
static_assert(contactRate_hz({.contact_rate_hz = 249.6}) == 249);

/// Of one finger with the bus for itself.
constexpr int fastestContactRate_hz(const Can& can) {
  return can.bitrate / (kFramesPerContact * kWorstFrame_bits);
}

}  // namespace strainfinger::config
