#pragma once
// A clock that goes on when the test says so.

#include "hal/clock.hpp"

namespace strainfinger::doubles {

class FakeClock {
 public:
  explicit FakeClock(std::uint32_t start_us = 0) : now_us_(start_us) {}
  void advance(std::uint32_t time_us) { now_us_ += time_us; }  ///< wraps as the contract says
  std::uint32_t now_us() const noexcept { return now_us_; }

 private:
  std::uint32_t now_us_;
};

static_assert(hal::Clock<FakeClock>);

}  // namespace strainfinger::doubles
