#include "host/live/bus_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "host/base/utc_text.hpp"
#include "host/can/remedies.hpp"

namespace strainfinger::live {
namespace {

/// The clock of TimedFrame, which may be set.
std::int64_t now_us() { return now_ns() / 1000; }

/// For requests: how long one waits has nothing to do with what time it is.
std::int64_t steady_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

BusWatch::BusWatch(can::BusPort& port, const config::FingerConfig& config,
                   std::optional<std::uint32_t> tables_crc32)
    : port_(port), fleet_(port.name(), config, tables_crc32) {
  port_.hearOthers([this](const can::OtherFrame& other) {
    fleet_.takeOther(clock_.at(other.time_ns / 1000), other);
    if (otherTap_) otherTap_(other);
  });
}

void BusWatch::listen(std::chrono::milliseconds time) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + time;
  const auto left = [end] {
    return std::chrono::ceil<std::chrono::milliseconds>(
        std::max(end - Clock::now(), Clock::duration::zero()));
  };
  do {
    sendRequests();
    if (port_.waitReadable(left())) std::this_thread::sleep_for(std::min(can::BusPort::kGather, left()));
    fetch();
  } while (Clock::now() < end);
}

void BusWatch::fetch() {
  while (const auto timed = port_.receiveTimed()) {
    fleet_.take(clock_.at(timed->time_ns / 1000), timed->frame);
    std::erase_if(requests_, [&](const PendingRequest& request) {
      const auto outcome = request.take(timed->frame);
      if (outcome) outcomes_.push_back(*outcome);
      return outcome.has_value();
    });
    if (tap_) tap_(*timed);
  }
}

void BusWatch::sendRequests() {
  for (PendingRequest& request : requests_)
    if (!request.isSent() && port_.send(request.frame())) request.markSent();
  std::erase_if(requests_, [&](const PendingRequest& request) {
    const auto outcome = request.expire(steady_us());
    if (outcome) outcomes_.push_back(*outcome);
    return outcome.has_value();
  });
}

BusView BusWatch::view() {
  BusView view = fleet_.view(clock_.at(now_us()));
  const hal::CanStatus status = port_.status();
  view.missed = status.missed;
  view.state = status.state;
  return view;
}

void BusWatch::request(std::uint8_t node, const RequestFrame& request) {
  if (std::ranges::find(requests_, node, &PendingRequest::node) != requests_.end()) return;
  const PendingRequest pending(node, request, steady_us());
  if (fleet_.hasTwin(node, clock_.at(now_us())))
    outcomes_.push_back(pending.refused(
        fmt::format("not sent: {}: {}", can::kTwinText, can::forNode(can::kTwinRemedy, port_.name(), node))));
  else
    requests_.push_back(pending);
}

}  // namespace strainfinger::live
