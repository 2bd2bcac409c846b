#include "host/can/loss_counter.hpp"

namespace strainfinger::can {
namespace {

/// A second contact has frames only while there is one, so that their numbers have gaps.
bool isOfEveryTouch(FunctionCode function) {
  return function != FunctionCode::kContact2 && function != FunctionCode::kForce2;
}

}  // namespace

void LossCounter::count(const std::string& interface, const CanFrame& frame) {
  if (countNumbered<ContactFrame>(interface, frame) || countNumbered<ForceFrame>(interface, frame) ||
      countNumbered<Contact2Frame>(interface, frame) || countNumbered<Force2Frame>(interface, frame))
    return;
  if (countNumbered<PatchFrame>(interface, frame))
    countAnnounced(streamOf(interface, *nodeOf(frame.id, FunctionCode::kPatch)), *decode<PatchFrame>(frame));
  if (const auto heartbeat = decode<HeartbeatFrame>(frame))
    countHeartbeat(streamOf(interface, *nodeOf(frame.id, FunctionCode::kHeartbeat)), *heartbeat);
}

LossCounter::Stream& LossCounter::streamOf(const std::string& interface, std::uint8_t node) {
  Stream& stream = streams_[{interface, node}];
  stream.seen.interface = interface;
  stream.seen.node = node;
  return stream;
}

/// False: it is another frame.
template <typename Frame>
bool LossCounter::countNumbered(const std::string& interface, const CanFrame& frame) {
  constexpr FunctionCode kFunction = kLayout<Frame>.spec.function;
  const auto values = decode<Frame>(frame);
  if (!values) return false;
  Stream& stream = streamOf(interface, *nodeOf(frame.id, kFunction));
  ++stream.seen.received;
  const std::uint8_t number = values->sequence;
  const auto [found, isFirst] = stream.numbers.try_emplace(kFunction, Numbers{number, std::nullopt});
  if (isFirst) return true;
  const std::uint8_t last = found->second.last;
  if (number == last)
    ++stream.seen.repeated;
  else if (isOfEveryTouch(kFunction))
    stream.seen.lost += static_cast<std::uint8_t>(number - last - 1);
  found->second = {number, last};
  return true;
}

/// What the PATCH before this one announced must have come by now, as the last of its kind or, where a
/// controller sends lower identifiers first, as the last but one.
void LossCounter::countAnnounced(Stream& stream, const PatchFrame& patch) {
  if (stream.announced == patch.sequence) return;
  if (stream.announced)
    for (const FunctionCode function : {FunctionCode::kContact2, FunctionCode::kForce2}) {
      const auto found = stream.numbers.find(function);
      if (found == stream.numbers.end() || !found->second.has(*stream.announced)) ++stream.seen.lost;
    }
  stream.announced.reset();
  if (patch.contacts >= 2) stream.announced = patch.sequence;
}

void LossCounter::countHeartbeat(Stream& stream, const HeartbeatFrame& heartbeat) {
  stream.seen.protocol = heartbeat.protocol;
  if (heartbeat.uptime_s == kNotKnown<std::uint16_t>) return;
  if (heartbeat.uptime_s < stream.uptime_s) {
    ++stream.seen.restarts;
    stream.numbers.clear();
    stream.announced.reset();
  }
  stream.uptime_s = heartbeat.uptime_s;
}

std::vector<NodeCount> LossCounter::counts() const {
  std::vector<NodeCount> result;
  for (const auto& [key, stream] : streams_) result.push_back(stream.seen);
  return result;
}

}  // namespace strainfinger::can
