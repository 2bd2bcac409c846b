#pragma once
// A hal::Watchdog for a machine that needs none: the system ends a process, nobody resets it.

#include "hal/watchdog.hpp"

namespace strainfinger::system {

class NoWatchdog {
 public:
  /// `cause`: why what runs here started.
  explicit NoWatchdog(hal::ResetCause cause = hal::ResetCause::kPowerOn) noexcept : cause_(cause) {}
  void feed() noexcept {}
  hal::ResetCause resetCause() const noexcept { return cause_; }

 private:
  hal::ResetCause cause_;
};

static_assert(hal::Watchdog<NoWatchdog>);

}  // namespace strainfinger::system
