#pragma once
// The gauges' converter, as the firmware sees it.

#include <array>
#include <concepts>
#include <cstdint>

#include "common/quantities.hpp"

namespace strainfinger::hal {

/// One code a gauge, left-justified to 16 bits whatever the converter's resolution: a 12-bit code c is
/// c << 4, so 0 is always the lower rail and mid-scale always 0x8000. Codes beyond the ring's gauges are
/// not looked at.
using SampleSet = std::array<std::uint16_t, kMaxGauges>;

/// Contract of a gauge converter:
///  - `read(set)` never blocks. True: `set` holds the oldest sample set not handed out yet, all gauges taken
///    in the same conversion period. False: nothing new; `set` is untouched.
///  - A set is handed out once. Sets the caller was too slow for are dropped, oldest first, and counted in
///    `overruns()`, which only grows.
///  - A converter that lost track of which code is which gauge's begins anew by itself; how often is
///    `resynchronisations()`, which only grows. No code is handed out as another gauge's.
// clang-format off
template <typename T>
concept GaugeAdc = requires(T adc, const T constAdc, SampleSet& set) {
  { adc.read(set) }
  noexcept->std::same_as<bool>;
  { constAdc.overruns() }
  noexcept->std::same_as<std::uint32_t>;
  { constAdc.resynchronisations() }
  noexcept->std::same_as<std::uint32_t>;
};
// clang-format on

}  // namespace strainfinger::hal
