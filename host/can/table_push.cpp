#include "host/can/table_push.hpp"

#include <cstring>

namespace strainfinger::can {
namespace {

using Clock = std::chrono::steady_clock;

std::uint32_t wordOf(const TableImage& image, std::uint16_t index) {
  std::uint32_t word = 0;
  std::memcpy(&word, reinterpret_cast<const char*>(&image) + std::size_t{index} * sizeof word, sizeof word);
  return word;
}

/// A finger takes a word again whose answer was lost.
Reply askAgain(BusPort& port, std::uint8_t node, const RequestFrame& request) {
  Reply reply;
  for (int attempt = 0; attempt < kAttempts && !reply.response; ++attempt) reply = ask(port, node, request);
  return reply;
}

bool isDone(const Reply& reply) { return reply.response && reply.response->status == CommandStatus::kDone; }

}  // namespace

TablePush pushTables(BusPort& port, std::uint8_t node, const TableImage& image,
                     const std::function<bool(int words)>& goOn) {
  TablePush push;
  push.reply = askAgain(port, node, loadRequest());
  while (isDone(push.reply) && push.words < kTableWords) {
    push.isStopped = !goOn(push.words);
    if (push.isStopped) break;
    const auto index = static_cast<std::uint16_t>(push.words);
    push.command = Command::kWord;
    push.reply = askAgain(port, node, wordRequest(index, wordOf(image, index)));
    push.words += isDone(push.reply);
  }
  return push;
}

std::optional<HeartbeatFrame> heartbeatAfterRestart(BusPort& port, std::uint8_t node,
                                                    std::chrono::milliseconds longest) {
  constexpr std::chrono::milliseconds kOnItsWay{20};  // what it said before it started anew
  const Clock::time_point begin = Clock::now(), end = begin + longest;
  for (auto now = begin; now < end; now = Clock::now()) {
    port.waitReadable(std::chrono::ceil<std::chrono::milliseconds>(end - now));
    while (const auto frame = port.receive()) {
      if (nodeOf(frame->id, FunctionCode::kHeartbeat) != node || Clock::now() < begin + kOnItsWay) continue;
      if (const auto heartbeat = decode<HeartbeatFrame>(*frame)) return heartbeat;
    }
  }
  return std::nullopt;
}

}  // namespace strainfinger::can
