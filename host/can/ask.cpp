#include "host/can/ask.hpp"

#include <algorithm>

namespace strainfinger::can {
namespace {

/// How long to wait for room in the interface's queue before the next attempt.
constexpr std::chrono::milliseconds kRetry{10};

void take(const CanFrame& frame, std::uint8_t node, Command command, Reply& reply) {
  const auto response = readSingleFrame<ResponseFrame>(frame, node);
  if (response && response->command == command) reply.response = response;
  if (nodeOf(frame.id, FunctionCode::kHeartbeat) != node) return;
  if (const auto heartbeat = decode<HeartbeatFrame>(frame)) reply.heartbeat = heartbeat;
}

}  // namespace

Reply ask(BusPort& port, std::uint8_t node, const RequestFrame& request, std::chrono::milliseconds longest) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + longest;
  const CanFrame frame = encode(request, node);
  Reply reply;
  for (auto now = Clock::now(); now < end && !reply.response; now = Clock::now()) {
    if (!reply.sent) reply.sent = port.send(frame);
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - now);
    port.waitReadable(reply.sent ? left : std::min(left, kRetry));
    while (const auto heard = port.receive())
      if (reply.sent) take(*heard, node, request.command, reply);
  }
  return reply;
}

}  // namespace strainfinger::can
