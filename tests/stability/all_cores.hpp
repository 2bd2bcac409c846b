#pragma once
// Work that falls into independent parts, on all cores.

#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace strainfinger::stability {

/// Calls work(i) for i = 0..count - 1, in that order but several at once.
template <typename Work>
void forEachOnAllCores(std::size_t count, Work work) {
  std::atomic<std::size_t> next = 0;
  const auto loop = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> workers;
  for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) workers.emplace_back(loop);
  loop();
}

}  // namespace strainfinger::stability
