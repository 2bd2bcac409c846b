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
  if (response && response->command == command) {
    reply.response = response;
    ++reply.responses;
  }
  if (nodeOf(frame.id, FunctionCode::kRequest) == node) reply.othersAsk = true;
  if (nodeOf(frame.id, FunctionCode::kRaw) == node && decode<RawFrame>(frame)) reply.sendsRaw = true;
  if (nodeOf(frame.id, FunctionCode::kHeartbeat) != node) return;
  if (const auto heartbeat = decode<HeartbeatFrame>(frame)) reply.heartbeat = heartbeat;
}

}  // namespace

std::string meaningOf(const ResponseFrame& response) {
  if (response.status == CommandStatus::kWait)
    return fmt::format("Not yet: {}; try again in {} s",
                       response.command == Command::kTare ? "a zero was taken or refused just now"
                                                          : "its memory would wear out",
                       response.value);
  if (response.status == CommandStatus::kTooFast)
    return fmt::format("Refused: more than RAW's share of the bus; {} Hz is the fastest", response.value);
  const int status = static_cast<int>(response.status);
  const ValueName* const name = findName(kCommandStatusNames, status);
  return name != nullptr ? name->comment : fmt::format("status {}, unknown to this program", status);
}

Reply ask(BusPort& port, std::uint8_t node, const RequestFrame& request, const Patience& patience) {
  using Clock = std::chrono::steady_clock;
  using std::chrono::milliseconds;
  const Clock::time_point begin = Clock::now();
  Clock::time_point end = begin + patience.longest;
  const CanFrame frame = encode(request, node);
  const auto goesOn = [&patience] { return !patience.goOn || patience.goOn(); };
  Reply reply;
  for (auto now = begin; now < end && goesOn(); now = Clock::now()) {
    if (!reply.sent) reply.sent = port.send(frame);
    const auto left = std::chrono::ceil<milliseconds>(end - now);
    port.waitReadable(std::min(left, reply.sent ? kGoOnEvery : kRetry));
    const bool wasAnswered = reply.response.has_value();
    while (const auto heard = port.receive())
      if (reply.sent) take(*heard, node, request.command, reply);
    if (!wasAnswered && reply.response) end = Clock::now() + patience.afterwards;
  }
  reply.waited = std::min(std::chrono::floor<milliseconds>(Clock::now() - begin), patience.longest);
  return reply;
}

std::map<std::uint8_t, HeartbeatFrame> listenForFingers(BusPort& port, std::chrono::milliseconds time,
                                                        const std::function<bool()>& goOn) {
  using Clock = std::chrono::steady_clock;
  std::map<std::uint8_t, HeartbeatFrame> heard;
  const Clock::time_point end = Clock::now() + time;
  for (auto now = Clock::now(); now < end && (!goOn || goOn()); now = Clock::now()) {
    port.waitReadable(std::min(kGoOnEvery, std::chrono::ceil<std::chrono::milliseconds>(end - now)));
    while (const auto frame = port.receive())
      if (const auto heartbeat = decode<HeartbeatFrame>(*frame))
        heard[*nodeOf(frame->id, FunctionCode::kHeartbeat)] = *heartbeat;
  }
  return heard;
}

/// A second answer may be one frame that came twice, or one to another program, which hardly happens twice:
/// so it is asked again before two fingers are told of.
Reply askWhoIsThere(BusPort& port, std::uint8_t node, const std::function<bool()>& goOn) {
  const auto askOnce = [&] {
    return ask(port, node, countRequest(Count::kErases), {.afterwards = kTwinWithin, .goOn = goOn});
  };
  const Reply reply = askOnce();
  return reply.responses > 1 ? askOnce() : reply;
}

}  // namespace strainfinger::can
