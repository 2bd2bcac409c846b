#pragma once
// A hal::Watchdog for a machine that needs none: the system ends a process, nobody resets it.

#include "hal/watchdog.hpp"

namespace strainfinger::system {

class NoWatchdog {
 public:
  void feed() noexcept {}
  hal::ResetCause resetCause() const noexcept { return hal::ResetCause::kPowerOn; }
};

static_assert(hal::Watchdog<NoWatchdog>);

}  // namespace strainfinger::system
