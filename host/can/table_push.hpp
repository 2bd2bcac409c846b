#pragma once
// Tables sent to a finger over the bus, as common/BUS_TABLES.md tells it.

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>

#include "common/table_image.hpp"
#include "host/can/ask.hpp"

namespace strainfinger::can {

struct TablePush {
  Command command = Command::kLoad;  ///< the last that was asked
  Reply reply{};                     ///< to it
  int words = 0;                     ///< of kTableWords, that the finger has
  bool isStopped = false;            ///< by goOn()
  bool isOutOfStep = false;          ///< the last answer was another word's
  bool othersAsk = false;            ///< somebody else asked the same node meanwhile
};

/// Sends `load` and then word by word the image, until one is refused, or has no answer or only
/// those of other words although it was said kPushAttempts times. `goOn(words)` is asked before each word,
/// and every kGoOnEvery at least while an answer is awaited; false ends it. What the port heard before is
/// gone.
TablePush pushTables(BusPort& port, std::uint8_t node, const TableImage& image, bool evenWhileTouched,
                     const std::function<bool(int words)>& goOn);

inline constexpr int kPushAttempts = 3;

/// Whether the finger's last start is known to be longer ago.
bool isOlderThan(const HeartbeatFrame& heartbeat, std::chrono::milliseconds time);

/// Waits for a finger that has answered a `restart`: its first HEARTBEAT in state run since it has started,
/// or the second in state fault, because the first may have been sent before. After `longest` the last of any
/// other kind; nothing where none came. `goOn()` is asked every kGoOnEvery at least; false ends it.
std::optional<HeartbeatFrame> heartbeatAfterRestart(BusPort& port, std::uint8_t node,
                                                    std::chrono::milliseconds longest,
                                                    const std::function<bool()>& goOn);

}  // namespace strainfinger::can
