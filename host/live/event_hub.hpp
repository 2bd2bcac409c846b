#pragma once
// The newest event, for any number of readers in threads of their own.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace strainfinger::live {

/// There is no queue: a reader that is slow misses events, and costs the others nothing.
class EventHub {
 public:
  struct Event {
    std::uint64_t number = 0;                   ///< 1, 2, ...; 0: none
    std::shared_ptr<const std::string> text{};  ///< null: none
  };

  void publish(std::string text) {
    {
      const std::lock_guard lock(mutex_);
      newest_ = {newest_.number + 1, std::make_shared<const std::string>(std::move(text))};
    }
    news_.notify_all();
  }

  /// The newest event if its number is above `last`, else the next one within that time; none after it, or
  /// when the hub is closed.
  Event next(std::uint64_t last, std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    news_.wait_for(lock, longest, [&] { return closed_ || newest_.number > last; });
    return !closed_ && newest_.number > last ? newest_ : Event{};
  }

  /// Wakes every reader; from then on there is nothing to read.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    news_.notify_all();
  }
  bool isClosed() {
    const std::lock_guard lock(mutex_);
    return closed_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable news_;
  Event newest_;
  bool closed_ = false;
};

}  // namespace strainfinger::live
