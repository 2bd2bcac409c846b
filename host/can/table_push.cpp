#include "host/can/table_push.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace strainfinger::can {
namespace {

std::uint32_t wordOf(const TableImage& image, std::uint16_t index) {
  std::uint32_t word = 0;
  std::memcpy(&word, reinterpret_cast<const char*>(&image) + std::size_t{index} * sizeof word, sizeof word);
  return word;
}

bool isDone(const Reply& reply) { return reply.response && reply.response->status == CommandStatus::kDone; }

/// A word that the finger has is answered with the next one: else the answer was another word's.
bool isStale(const Reply& reply, const RequestFrame& request) {
  return isDone(reply) && request.command == Command::kWord &&
         reply.response->value != std::uint32_t{request.argument} + 1;
}

/// A finger takes a word again whose answer was lost. A stale answer is the reply only if the last attempt
/// had no other.
Reply askAgain(BusPort& port, std::uint8_t node, const RequestFrame& request,
               const std::function<bool()>& goOn) {
  Reply reply;
  std::optional<ResponseFrame> stale;
  for (int attempt = 0; attempt < kPushAttempts && !reply.response && goOn(); ++attempt) {
    const auto waited = reply.waited;
    bool othersAsk = reply.othersAsk;
    while (const auto heard = port.receive()) othersAsk |= nodeOf(heard->id, FunctionCode::kRequest) == node;
    reply = ask(port, node, request, {.goOn = goOn});
    reply.othersAsk |= othersAsk;
    reply.waited += waited;
    stale.reset();
    if (isStale(reply, request)) stale = std::exchange(reply.response, std::nullopt);
  }
  if (stale) reply.response = stale;
  return reply;
}

}  // namespace

TablePush pushTables(BusPort& port, std::uint8_t node, const TableImage& image, bool evenWhileTouched,
                     const std::function<bool(int words)>& goOn) {
  TablePush push;
  const auto goesOn = [&] {
    push.isStopped = !goOn(push.words);
    return !push.isStopped;
  };
  const auto say = [&](const RequestFrame& request) {
    push.command = request.command;
    push.reply = askAgain(port, node, request, goesOn);
    push.othersAsk |= push.reply.othersAsk;
    push.isOutOfStep = isStale(push.reply, request);
    return isDone(push.reply) && !push.isOutOfStep;
  };
  bool isTaken = say(loadRequest(evenWhileTouched));
  while (isTaken && push.words < kTableWords && goesOn()) {
    const auto index = static_cast<std::uint16_t>(push.words);
    isTaken = say(wordRequest(index, wordOf(image, index)));
    push.words += isTaken;
  }
  return push;
}

bool isOlderThan(const HeartbeatFrame& heartbeat, std::chrono::milliseconds time) {
  return heartbeat.uptime_s != kNotKnown<std::uint16_t> &&
         std::chrono::seconds(heartbeat.uptime_s) > std::chrono::ceil<std::chrono::seconds>(time);
}

std::optional<HeartbeatFrame> heartbeatAfterRestart(BusPort& port, std::uint8_t node,
                                                    std::chrono::milliseconds longest,
                                                    const std::function<bool()>& goOn) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + longest;
  int faults = 0;
  std::optional<HeartbeatFrame> last;
  for (auto now = Clock::now(); now < end && goOn(); now = Clock::now()) {
    port.waitReadable(std::min(std::chrono::ceil<std::chrono::milliseconds>(end - now), kGoOnEvery));
    while (const auto frame = port.receive()) {
      if (nodeOf(frame->id, FunctionCode::kHeartbeat) != node) continue;
      const auto heartbeat = decode<HeartbeatFrame>(*frame);
      if (!heartbeat) continue;
      const bool isFault = heartbeat->state == FingerState::kFault;
      const bool isRunning = heartbeat->state == FingerState::kRun && !isOlderThan(*heartbeat, longest);
      if (isRunning || (isFault && ++faults == 2)) return heartbeat;
      if (!isFault) last = heartbeat;
    }
  }
  return last;
}

}  // namespace strainfinger::can
