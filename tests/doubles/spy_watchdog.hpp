#pragma once
// A watchdog that counts.

#include "hal/watchdog.hpp"

namespace strainfinger::doubles {

class SpyWatchdog {
 public:
  explicit SpyWatchdog(hal::ResetCause cause = hal::ResetCause::kPowerOn) : cause_(cause) {}
  void feed() noexcept { ++feeds_; }
  hal::ResetCause resetCause() const noexcept { return cause_; }
  int feeds() const { return feeds_; }

 private:
  hal::ResetCause cause_;
  int feeds_ = 0;
};

static_assert(hal::Watchdog<SpyWatchdog>);

}  // namespace strainfinger::doubles
