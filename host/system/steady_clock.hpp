#pragma once
// This machine's monotonic clock as a hal::Clock.

#include <chrono>

#include "hal/clock.hpp"

namespace strainfinger::system {

class SteadyClock {
 public:
  std::uint32_t now_us() const noexcept {
    using namespace std::chrono;
    const auto sinceBoot = steady_clock::now().time_since_epoch();
    return static_cast<std::uint32_t>(duration_cast<microseconds>(sinceBoot).count());
  }
};

static_assert(hal::Clock<SteadyClock>);

}  // namespace strainfinger::system
