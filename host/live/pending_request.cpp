#include "host/live/pending_request.hpp"

#include <fmt/format.h>

#include <chrono>

#include "host/can/ask.hpp"
#include "host/live/words.hpp"

namespace strainfinger::live {
namespace {

constexpr std::int64_t kLongest_us = std::chrono::microseconds(can::kAskFor).count();

}  // namespace

std::optional<Outcome> PendingRequest::take(const CanFrame& frame) const {
  const auto response = readSingleFrame<ResponseFrame>(frame, node_);
  if (!sent_ || !response || response->command != request_.command) return std::nullopt;
  const bool isDone =
      response->status == CommandStatus::kDone || response->status == CommandStatus::kDoneTouched;
  return outcome(isDone, can::meaningOf(*response));
}

std::optional<Outcome> PendingRequest::expire(std::int64_t now_us) const {
  if (now_us - asked_us_ < kLongest_us) return std::nullopt;
  return outcome(false,
                 sent_ ? "no answer: is it on the bus still?" : "the bus takes no frames: is it down?");
}

Outcome PendingRequest::outcome(bool isDone, const std::string& what) const {
  const std::string command = wordFor(kCommandNames, static_cast<int>(request_.command));
  return {node_, isDone, fmt::format("node {}: {}: {}", node_, command, what)};
}

}  // namespace strainfinger::live
