#pragma once
// Where readers in threads of their own leave what fingers are to do, and wait for what becomes of it.

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "host/live/pending_request.hpp"

namespace strainfinger::live {

/// Of one kind of command. Those who ask the same of a node at the same time get the same answer.
class CommandDesk {
 public:
  /// Waits for the outcome, at most so long; nothing: there was none in that time.
  std::optional<Outcome> ask(std::uint8_t node, std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    asked_.push_back(node);
    const Answer& answer = answers_[node];
    const std::uint64_t before = answer.number;
    if (!answered_.wait_for(lock, longest, [&] { return answer.number != before; })) return std::nullopt;
    return answer.outcome;
  }

  /// The nodes asked of since the last call, each once.
  std::vector<std::uint8_t> takeAsked() {
    const std::lock_guard lock(mutex_);
    std::sort(asked_.begin(), asked_.end());
    asked_.erase(std::unique(asked_.begin(), asked_.end()), asked_.end());
    return std::exchange(asked_, {});
  }

  void answer(const Outcome& outcome) {
    {
      const std::lock_guard lock(mutex_);
      Answer& answer = answers_[outcome.node];
      ++answer.number;
      answer.outcome = outcome;
    }
    answered_.notify_all();
  }

 private:
  struct Answer {
    std::uint64_t number = 0;
    Outcome outcome;
  };
  std::mutex mutex_;
  std::condition_variable answered_;
  std::vector<std::uint8_t> asked_;
  std::map<std::uint8_t, Answer> answers_;  ///< the last of each node
};

}  // namespace strainfinger::live
