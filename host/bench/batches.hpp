#pragma once
// Time of a piece of work on this machine.

#include <algorithm>
#include <array>
#include <chrono>

namespace strainfinger::bench {

/// The median over 15 batches of the time of work() [ns]; one more goes first, unmeasured. The median,
/// because what else the machine does only ever adds.
template <typename Work>
double medianTime_ns(Work work) {
  using Clock = std::chrono::steady_clock;
  std::array<double, 15> times;
  work();
  for (double& time : times) {
    const auto begin = Clock::now();
    work();
    time = std::chrono::duration<double, std::nano>(Clock::now() - begin).count();
  }
  std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
  return times[times.size() / 2];
}

}  // namespace strainfinger::bench
