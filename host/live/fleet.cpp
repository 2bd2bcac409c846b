#include "host/live/fleet.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "host/can/frame_catalogue.hpp"
#include "host/can/other_tables.hpp"

namespace strainfinger::live {
namespace {

/// In contact a finger sends every 50 ms at least: after four times that it says nothing more of it.
constexpr std::int64_t kTouchLasts_us = 4'000 * std::int64_t{kContactPeriod_ms};

/// Of RAW there is one set a second at least.
constexpr std::int64_t kRawLasts_us = 1'500'000;

/// Two fingers of one number give themselves away once a second at least while both are there.
constexpr std::int64_t kTwinLasts_us = 3'000'000;

void widen(double& least, double& most, double value) {
  least = std::fmin(least, value);  // fmin and fmax pass over what is not known
  most = std::fmax(most, value);
}

double jitterOf(std::span<const std::int64_t> intervals_us) {
  if (intervals_us.empty()) return kNoValue;
  std::int64_t worst_us = 0;
  for (const std::int64_t interval_us : intervals_us)
    worst_us = std::max(worst_us, std::abs(interval_us - 1'000 * std::int64_t{kHeartbeatPeriod_ms}));
  return static_cast<double>(worst_us) / 1e6;
}

}  // namespace

Fleet::Node& Fleet::nodeAt(std::uint8_t number) {
  return nodes_.try_emplace(number, number, gauges_).first->second;
}

void Fleet::take(std::int64_t time_us, const CanFrame& frame) {
  now_us_ = std::max(now_us_, time_us);
  frames_.add(now_us_);
  bits_.add(now_us_, unstuffedBits(frame.length));
  const auto number = can::fingerNode(frame.id);
  if (!number) return;
  Node& node = nodeAt(*number);
  countLosses(*number, node, frame);
  if (decode<ContactFrame>(frame)) node.contacts.add(now_us_);
  if (decode<RawFrame>(frame)) node.rawBits.add(now_us_, unstuffedBits(frame.length));
  if (const auto touch = node.receiver.take(frame)) takeTouch(node, now_us_, *touch);
  if (const auto set = node.raw.take(frame)) {
    node.strains = set->strains;
    node.strained_us = now_us_;
  }
  if (const auto heartbeat = decode<HeartbeatFrame>(frame)) takeHeartbeat(node, now_us_, *heartbeat);
  if (const auto info = decode<InfoFrame>(frame)) node.info = info;
  if (const auto gauges = decode<GaugesFrame>(frame)) node.gauges = gauges;
}

void Fleet::takeOther(std::int64_t time_us, const can::OtherFrame& other) {
  now_us_ = std::max(now_us_, time_us);
  frames_.add(now_us_);
  bits_.add(now_us_, can::unstuffedBits(other));
}

/// What a twin left behind that has gone is not taken together with what may look like one later.
void Fleet::countLosses(std::uint8_t number, Node& node, const CanFrame& frame) {
  if (node.twin_us != 0 && now_us_ - node.twin_us > kTwinLasts_us) {
    losses_.forgetTwin(name_, number);
    node.twin_us = 0;
  }
  if (losses_.count(name_, frame)) node.twin_us = now_us_;
}

bool Fleet::showsTwin(const can::NodeCount& count, const Node& node, std::int64_t now_us) {
  return count.twoSenders && now_us - node.twin_us <= kTwinLasts_us;
}

void Fleet::takeHeartbeat(Node& node, std::int64_t time_us, const HeartbeatFrame& heartbeat) {
  if (node.heartbeat)
    node.intervals_us[node.intervals++ % node.intervals_us.size()] = time_us - node.heard_us;
  node.heartbeat = heartbeat;
  node.heard_us = time_us;
}

void Fleet::takeTouch(Node& node, std::int64_t time_us, const can::TouchReport& touch) {
  const bool isNews =
      !node.touch || node.touch->flags.has(FingerFlag::kContact) != touch.flags.has(FingerFlag::kContact);
  if (isNews) node.since_us = time_us;
  node.touch = touch;
  node.touched_us = time_us;
  widen(node.span.leastNormal_n, node.span.mostNormal_n, touch.normal_n);
  widen(node.span.leastTangential_n, node.span.mostTangential_n, touch.tangential_n);
  node.strongest_n = std::fmax(node.strongest_n, std::abs(touch.normal_n));
  node.strongest_n = std::fmax(node.strongest_n, std::abs(touch.tangential_n));
}

BusView Fleet::view(std::int64_t now_us) {
  now_us_ = std::max(now_us_, now_us);
  BusView view{.name = name_, .time_us = now_us_, .framesPerSecond = frames_.perSecond(now_us_)};
  view.load = loadOf(bits_);
  for (auto& [number, node] : nodes_)
    if (node.heartbeat) view.fingers.push_back(viewOf(number, node));
  for (const can::NodeCount& count : losses_.counts()) {
    const auto finger = std::ranges::find(view.fingers, count.node, &FingerView::node);
    if (finger == view.fingers.end()) continue;
    finger->received = count.received;
    finger->lost = count.lost;
    finger->restarts = count.restarts;
    finger->hasTwin = showsTwin(count, nodes_.at(count.node), now_us_);
  }
  return view;
}

bool Fleet::hasTwin(std::uint8_t number, std::int64_t now_us) const {
  const auto node = nodes_.find(number);
  return node != nodes_.end() && std::ranges::any_of(losses_.counts(), [&](const can::NodeCount& count) {
           return count.node == number && showsTwin(count, node->second, now_us);
         });
}

double Fleet::loadOf(RateMeter& bits) const {
  return static_cast<double>(bits.perSecond(now_us_)) / bitrate_;
}

FingerView Fleet::viewOf(std::uint8_t number, Node& node) {
  const std::size_t intervals = std::min(node.intervals, node.intervals_us.size());
  FingerView view{.bus = name_,
                  .node = number,
                  .silence_us = now_us_ - node.heard_us,
                  .heartbeat = *node.heartbeat,
                  .info = node.info,
                  .gauges = node.gauges,
                  .touch = node.touch,
                  .touched_us = node.touched_us,
                  .since_us = node.since_us,
                  .span = std::exchange(node.span, {}),
                  .strongest_n = node.strongest_n,
                  .contactsPerSecond = node.contacts.perSecond(now_us_),
                  .jitter_s = jitterOf(std::span(node.intervals_us).first(intervals))};
  view.rawLoad = loadOf(node.rawBits);
  const bool isOld = view.isTouched() && now_us_ - node.touched_us > kTouchLasts_us;
  if (view.isSilent() || view.isForeign() || isOld) view.touch.reset();
  if (view.isForeign()) {  // all else in its frames means something else
    view.heartbeat = {.protocol = view.heartbeat.protocol};
    view.info.reset();
    view.gauges.reset();
  }
  view.hasOtherTables =
      number == configured_ && tables_crc32_ && can::hasOtherTables(view.heartbeat, *tables_crc32_);
  if (!view.isForeign() && now_us_ - node.strained_us <= kRawLasts_us) view.strains = node.strains;
  return view;
}

}  // namespace strainfinger::live
