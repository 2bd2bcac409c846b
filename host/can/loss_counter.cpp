#include "host/can/loss_counter.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/base/failure.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/can/remedies.hpp"

namespace strainfinger::can {
namespace {

/// So many resumptions where a gap began, and one for so many gaps, are no chance: lost frames look like one
/// resumption in 256 gaps.
constexpr std::uint64_t kFewestResumptions = 3;
constexpr std::uint64_t kGapsPerResumption = 4;

/// A finger sends ten or eleven heartbeats in a second of its uptime.
constexpr int kHeartbeatsOfTwo = 1000 / kHeartbeatPeriod_ms * 3 / 2;

/// Uptimes go on by a second at a time, two where heartbeats were lost.
constexpr int kUptimeStep_s = 2;

constexpr std::uint16_t kLongestUptime_s = kNotKnown<std::uint16_t> - 1;  ///< or more

/// Of tables that come and go the last ones are enough to know.
constexpr std::size_t kMostTables = 8;

/// A second contact has frames only while there is one, so that their numbers have gaps.
bool isOfEveryTouch(FunctionCode function) {
  return function != FunctionCode::kContact2 && function != FunctionCode::kForce2;
}

std::size_t indexOf(FunctionCode function) { return static_cast<std::uint16_t>(function) / kIdsPerFunction; }

}  // namespace

std::string tableChangesText(const NodeCount& node) {
  if (node.tables.size() < 2) return "";
  return fmt::format(
      "its tables changed meanwhile (last bytes of their CRC-32: {:02X}): it was sent others, or another "
      "finger took its place; what it said before and after are to be read with different configs",
      fmt::join(node.tables, ", "));
}

void requireOurProtocol(const NodeCount& node) {
  if (!node.protocol || *node.protocol == kProtocolVersion) return;
  throw Failure(ExitCode::kMismatch, fmt::format("{} node {} {}; its frames mean something else",
                                                 node.interface, node.node, foreignText(*node.protocol)));
}

bool LossCounter::Evidence::isOfTwo() const {
  return resumptions >= kFewestResumptions && resumptions * kGapsPerResumption >= gaps;
}

bool LossCounter::count(std::string_view interface, const CanFrame& frame) {
  const FrameEntry* const entry = findFrame(frame);
  if (entry == nullptr) return false;
  const FunctionCode function = entry->spec.function;
  Stream& stream = streams_.at(interface, *nodeOf(frame.id, function));
  const std::uint64_t before = stream.evidence.resumptions;
  countFrame(stream, function, frame);
  return stream.evidence.resumptions > before;
}

void LossCounter::forgetTwin(std::string_view interface, std::uint8_t node) {
  Stream& stream = streams_.at(interface, node);
  if (stream.evidence.isOfTwo()) stream.evidence = {};
}

void LossCounter::countFrame(Stream& stream, FunctionCode function, const CanFrame& frame) {
  const auto countSequence = [&](const auto& values) {
    countNumber(stream, function, values->sequence, toWord(frame));
  };
  switch (function) {
    case FunctionCode::kContact:
      return countSequence(decode<ContactFrame>(frame));
    case FunctionCode::kForce:
      return countSequence(decode<ForceFrame>(frame));
    case FunctionCode::kContact2:
      return countSequence(decode<Contact2Frame>(frame));
    case FunctionCode::kForce2:
      return countSequence(decode<Force2Frame>(frame));
    case FunctionCode::kPatch:
      countSequence(decode<PatchFrame>(frame));
      return countAnnounced(stream, *decode<PatchFrame>(frame));
    case FunctionCode::kHeartbeat:
      return countHeartbeat(stream, *decode<HeartbeatFrame>(frame));
    case FunctionCode::kInfo:
      return countBoard(stream, decode<InfoFrame>(frame)->board);
    default:
      return;
  }
}

void LossCounter::countNumber(Stream& stream, FunctionCode function, std::uint8_t number,
                              std::uint64_t data) {
  ++stream.seen.received;
  std::optional<Numbers>& numbers = stream.numbers[indexOf(function)];
  if (!numbers) {
    numbers = Numbers{number, data};
    return;
  }
  if (number == numbers->last) {
    ++stream.seen.repeated;
    if (data != numbers->data) ++stream.evidence.resumptions;  // two senders in step
  } else if (isOfEveryTouch(function)) {
    countGap(stream, *numbers, number);
  }
  numbers->before = numbers->last;
  numbers->last = number;
  numbers->data = data;
}

/// A number that goes on where a gap began is another sender's, and that gap was none.
void LossCounter::countGap(Stream& stream, Numbers& numbers, std::uint8_t number) {
  const auto gap = static_cast<std::uint8_t>(number - numbers.last - 1);
  if (gap == 0) return;
  const bool resumes = numbers.beforeGap && number == static_cast<std::uint8_t>(*numbers.beforeGap + 1);
  if (resumes) {
    ++stream.evidence.resumptions;
    stream.seen.lost -= numbers.gap;
  } else {
    ++stream.evidence.gaps;
    stream.seen.lost += gap;
  }
  numbers.beforeGap = numbers.last;
  numbers.gap = resumes ? std::uint8_t{0} : gap;
}

/// What the PATCH before this one announced must have come by now, as the last of its kind or, where a
/// controller sends lower identifiers first, as the last but one.
void LossCounter::countAnnounced(Stream& stream, const PatchFrame& patch) {
  if (stream.announced == patch.sequence) return;
  if (stream.announced)
    for (const FunctionCode function : {FunctionCode::kContact2, FunctionCode::kForce2}) {
      const std::optional<Numbers>& numbers = stream.numbers[indexOf(function)];
      if (!numbers || !numbers->has(*stream.announced)) ++stream.seen.lost;
    }
  stream.announced.reset();
  if (patch.contacts >= 2) stream.announced = patch.sequence;
}

void LossCounter::countHeartbeat(Stream& stream, const HeartbeatFrame& heartbeat) {
  stream.seen.protocol = heartbeat.protocol;
  if (heartbeat.uptime_s != kNotKnown<std::uint16_t>) countUptime(stream, heartbeat.uptime_s);
  countTables(stream, heartbeat);
}

/// Tables that come back without a restart are those of another finger: one is sent others in state fault,
/// and starts with them.
void LossCounter::countTables(Stream& stream, const HeartbeatFrame& heartbeat) {
  std::vector<std::uint8_t>& tables = stream.seen.tables;
  if (heartbeat.protocol != kProtocolVersion || heartbeat.state == FingerState::kFault) return;
  if (!tables.empty() && tables.back() == heartbeat.table_crc) return;
  if (stream.tablesBefore == heartbeat.table_crc) ++stream.evidence.resumptions;
  if (!tables.empty()) stream.tablesBefore = tables.back();
  if (tables.size() == kMostTables) tables.erase(tables.begin());
  tables.push_back(heartbeat.table_crc);
}

void LossCounter::countUptime(Stream& stream, std::uint16_t uptime_s) {
  const int last_s = stream.uptime_s.value_or(uptime_s);
  stream.uptime_s = uptime_s;
  stream.sameUptime = uptime_s == last_s ? stream.sameUptime + 1 : 1;
  if (stream.sameUptime == kHeartbeatsOfTwo && uptime_s != kLongestUptime_s) ++stream.evidence.resumptions;
  if (uptime_s >= last_s && uptime_s <= last_s + kUptimeStep_s) return;
  if (uptime_s < last_s && uptime_s >= last_s - kUptimeStep_s && uptime_s > kUptimeStep_s) {
    ++stream.evidence.resumptions;  // a finger that restarted would begin at 0
    return;
  }
  const bool resumes = stream.uptimeBeforeJump_s && uptime_s >= *stream.uptimeBeforeJump_s &&
                       uptime_s <= *stream.uptimeBeforeJump_s + kUptimeStep_s;
  stream.uptimeBeforeJump_s = static_cast<std::uint16_t>(last_s);
  if (resumes) {
    ++stream.evidence.resumptions;
  } else if (uptime_s < last_s) {
    ++stream.seen.restarts;
    stream.tablesBefore.reset();
    stream.numbers = {};
    stream.announced.reset();
  }
}

void LossCounter::countBoard(Stream& stream, std::uint8_t board) {
  if (board == 0 || board == stream.board) return;
  if (board == stream.boardBefore) ++stream.evidence.resumptions;
  stream.boardBefore = stream.board;
  stream.board = board;
}

std::vector<NodeCount> LossCounter::counts() const {
  std::vector<NodeCount> result;
  streams_.forEach([&result](const std::string& interface, std::uint8_t node, const Stream& stream) {
    NodeCount& count = result.emplace_back(stream.seen);
    count.interface = interface;
    count.node = node;
    count.twoSenders = stream.evidence.isOfTwo();
  });
  return result;
}

}  // namespace strainfinger::can
