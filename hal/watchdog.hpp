#pragma once
// The watchdog, as the firmware sees it.

#include <concepts>
#include <cstdint>

namespace strainfinger::hal {

/// Why the board started. The numbers go on the bus: never reuse one.
enum class ResetCause : std::uint8_t {
  kUnknown = 0,
  kPowerOn = 1,
  kPin = 2,
  kSoftware = 3,
  kWatchdog = 4,
  kBrownOut = 5
};

/// Contract of a watchdog: once started it resets the board unless `feed()` is called within its period;
/// `resetCause()` says why the board started last and does not change while it runs.
// clang-format off
template <typename T>
concept Watchdog = requires(T watchdog, const T constWatchdog) {
  { watchdog.feed() }
  noexcept->std::same_as<void>;
  { constWatchdog.resetCause() }
  noexcept->std::same_as<ResetCause>;
};
// clang-format on

}  // namespace strainfinger::hal
