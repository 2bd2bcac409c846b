#pragma once
// A beat in real time.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <thread>

namespace strainfinger::system {

/// Beats at whole periods of the monotonic clock since its construction, so lateness never adds up.
class Metronome {
 public:
  explicit Metronome(std::chrono::microseconds period) : period_(period) {}

  /// Sleeps until the next beat; at once when that is past. How many beats have gone by since the last call:
  /// more than one when the caller or the system was late.
  std::uint64_t wait() {
    std::this_thread::sleep_until(start_ + (beats_ + 1) * period_);
    const auto before = beats_;
    beats_ = std::max(beats_ + 1, static_cast<std::int64_t>((Clock::now() - start_) / period_));
    return static_cast<std::uint64_t>(beats_ - before);
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::chrono::microseconds period_;
  Clock::time_point start_ = Clock::now();
  std::int64_t beats_ = 0;
};

}  // namespace strainfinger::system
