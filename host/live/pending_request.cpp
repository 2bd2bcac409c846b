#include "host/live/pending_request.hpp"

#include <fmt/format.h>

#include "host/can/frame_catalogue.hpp"
#include "host/live/words.hpp"

namespace strainfinger::live {
namespace {

constexpr std::int64_t kLongest_us = 2'000 * std::int64_t{kAnswerWithin_ms};

std::string meaningOfStatus(const ResponseFrame& response) {
  const ValueName* name = can::findName(kCommandStatusNames, static_cast<int>(response.status));
  if (name == nullptr) return fmt::format("status {}, unknown to this program", static_cast<int>(response.status));
  if (response.status == CommandStatus::kWait) return fmt::format("{}: {} s", name->comment, response.value);
  return name->comment;
}

}  // namespace

std::optional<std::string> PendingRequest::take(const CanFrame& frame) const {
  const auto response = readSingleFrame<ResponseFrame>(frame, node_);
  if (!sent_ || !response || response->command != request_.command) return std::nullopt;
  return told(meaningOfStatus(*response));
}

std::optional<std::string> PendingRequest::expire(std::int64_t now_us) const {
  if (now_us - asked_us_ < kLongest_us) return std::nullopt;
  return told(sent_ ? "no answer: is it on the bus still?" : "the bus takes no frames: is it down?");
}

std::string PendingRequest::told(const std::string& what) const {
  return fmt::format("node {}: {}: {}", node_, wordFor(kCommandNames, static_cast<int>(request_.command)), what);
}

}  // namespace strainfinger::live
