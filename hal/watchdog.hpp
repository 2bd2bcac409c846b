#pragma once
// The watchdog, as the firmware sees it.

#include <concepts>
#include <cstdint>

#include "common/frames.hpp"

namespace strainfinger::hal {

using strainfinger::ResetCause;

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
