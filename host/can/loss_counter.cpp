#include "host/can/loss_counter.hpp"

namespace strainfinger::can {

void LossCounter::count(const std::string& interface, const CanFrame& frame) {
  if (const auto contact = decode<ContactFrame>(frame)) {
    Stream& stream = streamOf(interface, *nodeOf(frame.id, FunctionCode::kContact));
    countSequence(stream, stream.lastContact, contact->sequence);
  } else if (const auto force = decode<ForceFrame>(frame)) {
    Stream& stream = streamOf(interface, *nodeOf(frame.id, FunctionCode::kForce));
    countSequence(stream, stream.lastForce, force->sequence);
  } else if (const auto heartbeat = decode<HeartbeatFrame>(frame)) {
    countHeartbeat(streamOf(interface, *nodeOf(frame.id, FunctionCode::kHeartbeat)), *heartbeat);
  }
}

LossCounter::Stream& LossCounter::streamOf(const std::string& interface, std::uint8_t node) {
  Stream& stream = streams_[{interface, node}];
  stream.seen.interface = interface;
  stream.seen.node = node;
  return stream;
}

void LossCounter::countSequence(Stream& stream, std::optional<std::uint8_t>& last, std::uint8_t sequence) {
  ++stream.seen.received;
  if (last && *last == sequence)
    ++stream.seen.repeated;
  else if (last)
    stream.seen.lost += static_cast<std::uint8_t>(sequence - *last - 1);
  last = sequence;
}

void LossCounter::countHeartbeat(Stream& stream, const HeartbeatFrame& heartbeat) {
  stream.seen.protocol = heartbeat.protocol;
  if (heartbeat.uptime_s == kNotKnown<std::uint16_t>) return;
  if (heartbeat.uptime_s < stream.uptime_s) {
    ++stream.seen.restarts;
    stream.lastContact.reset();
    stream.lastForce.reset();
  }
  stream.uptime_s = heartbeat.uptime_s;
}

std::vector<NodeCount> LossCounter::counts() const {
  std::vector<NodeCount> result;
  for (const auto& [key, stream] : streams_) result.push_back(stream.seen);
  return result;
}

}  // namespace strainfinger::can
