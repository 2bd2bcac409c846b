#pragma once
// How much of a bus the gauges' readings may take.

#include <algorithm>
#include <cstdint>

#include "common/can_frame.hpp"
#include "common/commands.hpp"

namespace strainfinger {

inline constexpr std::uint32_t kCodesPerPage = 3;

/// Frames of RAW that a sample set of so many gauges takes.
constexpr std::uint32_t rawPages(std::uint32_t gauges) {
  return (gauges + kCodesPerPage - 1) / kCodesPerPage;
}

/// Of the bits on the bus, without stuff bits: what is left is for two fingers' touches, 500 a second each.
/// Touches have the lower identifiers, so they go first even where the bus is full.
inline constexpr std::uint32_t kRawShare_percent = 67;
inline constexpr std::uint32_t kFrameBits = unstuffedBits(8);

/// The fastest rate that keeps to the share: 1000 Hz for 16 gauges at 1 Mbit/s; 0: not even one a second.
/// Domain: one gauge or more.
constexpr std::uint16_t fastestRaw_hz(std::uint32_t gauges, std::uint32_t bitrate) {
  const std::uint32_t fits = bitrate / 100 * kRawShare_percent / (kFrameBits * rawPages(gauges));
  return static_cast<std::uint16_t>(std::min<std::uint32_t>(fits, kFastestRaw_hz));
}
static_assert(fastestRaw_hz(16, 1'000'000) == 1000);

}  // namespace strainfinger
