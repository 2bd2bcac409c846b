#pragma once
// How many contacts a second a bus can carry.

#include <cstdint>

#include "host/config/finger_config.hpp"

namespace strainfinger::config {

/// Bits on the bus of an 8-byte frame with an 11-bit identifier, stuffed at worst: 8 n + 44 fixed bits, 3 of
/// interframe space, a stuff bit for every 4 of the 34 + 8 n - 1 that are subject to it.
inline constexpr int kWorstFrame_bits = 8 * 8 + 44 + 3 + (34 + 8 * 8 - 1) / 4;
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
