#pragma once
// Time that passes when it is told to.

#include <cstdint>

#include "hal/clock.hpp"

namespace strainfinger::simulation {

class SimulatedClock {
 public:
  std::uint32_t now_us() const noexcept { return static_cast<std::uint32_t>(elapsed_us_); }
  std::uint64_t elapsed_us() const noexcept { return elapsed_us_; }  ///< since the start; never wraps
  void advance_us(std::uint64_t by_us) noexcept { elapsed_us_ += by_us; }

 private:
  std::uint64_t elapsed_us_ = 0;
};

static_assert(hal::Clock<SimulatedClock>);

}  // namespace strainfinger::simulation
