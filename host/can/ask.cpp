#include "host/can/ask.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/can/frame_catalogue.hpp"

namespace strainfinger::can {
namespace {

/// How long to wait for room in the interface's queue before the next attempt.
constexpr std::chrono::milliseconds kRetry{10};

void take(const CanFrame& frame, std::uint8_t node, Command command, Reply& reply) {
  const auto response = readSingleFrame<ResponseFrame>(frame, node);
  if (response && response->command == command) reply.response = response;
  if (nodeOf(frame.id, FunctionCode::kRequest) == node) reply.othersAsk = true;
  if (nodeOf(frame.id, FunctionCode::kHeartbeat) != node) return;
  if (const auto heartbeat = decode<HeartbeatFrame>(frame)) reply.heartbeat = heartbeat;
}

}  // namespace

std::string meaningOf(const ResponseFrame& response) {
  if (response.status == CommandStatus::kWait)
    return fmt::format(
        "Not yet: {}: {} s",
        response.command == Command::kTare ? "the zero was taken just now" : "its memory would wear out",
        response.value);
  if (response.status == CommandStatus::kTooFast)
    return fmt::format("Refused: more than RAW's share of the bus; {} Hz is the fastest", response.value);
  const int status = static_cast<int>(response.status);
  const ValueName* const name = findName(kCommandStatusNames, status);
  return name != nullptr ? name->comment : fmt::format("status {}, unknown to this program", status);
}

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
