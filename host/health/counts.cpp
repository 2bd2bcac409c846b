#include "host/health/counts.hpp"

#include "host/can/ask.hpp"

namespace strainfinger::health {
namespace {

/// Attempts to get an answer: a response doesn't say which count it is of, and frames get lost.
constexpr int kAttempts = 4, kSilentAttempts = 2;

Counted askFor(can::BusPort& port, std::uint8_t node, Count count) {
  for (int attempt = 1, silent = 0; attempt <= kAttempts; ++attempt) {
    const can::Reply reply = can::ask(port, node, countRequest(count));
    if (!reply.sent) return {count, CountAnswer::kNotSent};
    if (!reply.response && ++silent == kSilentAttempts) return {count, CountAnswer::kSilence};
    if (!reply.response || reply.othersAsk) continue;
    if (reply.response->status != CommandStatus::kDone) return {count, CountAnswer::kNotCounted};
    return {count, CountAnswer::kTold, reply.response->value};
  }
  return {count, CountAnswer::kOthersAsk};
}

}  // namespace

std::vector<Counted> askForCounts(can::BusPort& port, std::uint8_t node) {
  std::vector<Counted> counts;
  for (const ValueName& name : kCountNames) {
    const bool isOver = !counts.empty() && (counts.back().answer == CountAnswer::kSilence ||
                                            counts.back().answer == CountAnswer::kNotSent);
    counts.push_back(isOver ? Counted{Count{name.value}, counts.back().answer}
                            : askFor(port, node, Count{name.value}));
  }
  return counts;
}

}  // namespace strainfinger::health
