#include "host/recompute/recomputer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "firmware/app/finger.hpp"
#include "host/base/failure.hpp"
#include "host/can/candump_text.hpp"
#include "host/system/no_watchdog.hpp"

namespace strainfinger::recompute {
namespace {

constexpr std::array kTouchFunctions{FunctionCode::kContact, FunctionCode::kForce, FunctionCode::kPatch,
                                     FunctionCode::kContact2, FunctionCode::kForce2};

bool isTouchOf(std::uint8_t node, const CanFrame& frame) {
  return std::ranges::any_of(kTouchFunctions,
                             [&](FunctionCode function) { return frame.id == canId(function, node); });
}

/// Where all frames of touches have their sequence number.
constexpr std::size_t kSequenceByte = 7;
static_assert(encode(ContactFrame{.sequence = 1}, kFirstNode).data[kSequenceByte] == 1);

std::string hexOf(const CanFrame& frame) {
  const std::string line = can::formatLogLine(0, "x", frame);
  return line.substr(line.rfind(' ') + 1);
}

/// The sets of a recording, one at a time.
struct RecordedAdc {
  const can::RawSet* set = nullptr;
  bool read(hal::SampleSet& to) noexcept {
    if (set == nullptr) return false;
    std::ranges::copy(std::exchange(set, nullptr)->codes, to.begin());
    return true;
  }
  std::uint32_t overruns() const noexcept { return 0; }
  std::uint32_t resynchronisations() const noexcept { return 0; }
};

/// A bus that is always free.
struct FreePort {
  std::vector<CanFrame> sent;
  bool send(const CanFrame& frame) noexcept {
    sent.push_back(frame);
    return true;
  }
  std::optional<CanFrame> receive() noexcept { return std::nullopt; }
  hal::CanStatus status() const noexcept { return {.state = hal::CanState::kActive}; }
};

struct SetClock {
  std::uint32_t time_us = 0;
  std::uint32_t now_us() const noexcept { return time_us; }
};

/// What no reading tells, as the recording has it.
template <typename Frame>
void adopt(Frame& computed, const Frame& recorded, std::uint8_t firstSequence) {
  computed.sequence = static_cast<std::uint8_t>(computed.sequence + firstSequence);
  for (const FingerFlag flag : {FingerFlag::kUncalibrated, FingerFlag::kSimulated})
    computed.flags.set(flag, recorded.flags.has(flag));
}

template <typename Frame>
bool adoptIf(CanFrame& computed, const CanFrame& recorded, std::uint8_t node, std::uint8_t firstSequence) {
  auto values = decode<Frame>(computed);
  const auto others = decode<Frame>(recorded);
  if (!values || !others) return false;
  adopt(*values, *others, firstSequence);
  computed = encode(*values, node);
  return true;
}

/// The computed frame with what only the recording tells.
CanFrame adopted(CanFrame computed, const CanFrame& recorded, std::uint8_t node, std::uint8_t firstSequence) {
  static_cast<void>(adoptIf<ContactFrame>(computed, recorded, node, firstSequence) ||
                    adoptIf<ForceFrame>(computed, recorded, node, firstSequence) ||
                    adoptIf<PatchFrame>(computed, recorded, node, firstSequence) ||
                    adoptIf<Contact2Frame>(computed, recorded, node, firstSequence) ||
                    adoptIf<Force2Frame>(computed, recorded, node, firstSequence));
  return computed;
}

}  // namespace

/// The finger, as it is after a tare.
class Recomputer::Engine {
 public:
  Engine(const TableImage& tables, const RecordedFinger& finger)
      : finger_(tables,
                {.node = finger.node,
                 .contactRate_hz = finger.contactRate_hz,
                 .samplePeriod_us = kPeriod_us,
                 .mode = finger.mode},
                adc_, port_, clock_, watchdog_) {}

  /// The frames that the set makes it send.
  std::vector<CanFrame> pass(const can::RawSet& set) {
    adc_.set = &set;
    clock_.time_us += kPeriod_us;
    finger_.step();
    return std::exchange(port_.sent, {});
  }

 private:
  static constexpr std::uint16_t kPeriod_us = 1000;

  RecordedAdc adc_;
  FreePort port_;
  SetClock clock_;
  system::NoWatchdog watchdog_;
  firmware::Finger<RecordedAdc, FreePort, SetClock, system::NoWatchdog> finger_;
};

Recomputer::Recomputer(const TableImage& tables, const RecordedFinger& finger)
    : tables_(tables), finger_(finger), receiver_(finger.node, tables.constants.gauge_count) {}

Recomputer::~Recomputer() = default;

void Recomputer::take(std::int64_t time_ns, const CanFrame& frame) {
  if (const auto set = receiver_.take(frame)) return take(*set);
  const auto heartbeat = decode<HeartbeatFrame>(frame);
  const bool isOurs = nodeOf(frame.id, FunctionCode::kHeartbeat) == finger_.node;
  if (heartbeat && isOurs && heartbeat->table_crc != tableCrcByte(tables_.crc32))
    throw Failure(
        ExitCode::kMismatch,
        fmt::format("node {} has tables with a CRC-32 that ends in {:02X}, these end in {:02X}: give "
                    "the finger's config, or its --tables",
                    finger_.node, heartbeat->table_crc, tableCrcByte(tables_.crc32)));
  const auto response = readSingleFrame<ResponseFrame>(frame, finger_.node);
  const bool isTareRefused =
      response && response->command == Command::kTare && response->status == CommandStatus::kTouched;
  if (isTareRefused && wasZeroing_) return end();  // the old zero stays, and what made it is not known here
  const bool isKnown = engine_ != nullptr && zeroingSets_ == firmware::ZeroAverage::kSamples;
  if (!isKnown || !isTouchOf(finger_.node, frame) || isOfTouchBefore(frame)) return;
  recorded_[frame.id].push_back({time_ns, frame});
  compareAll();
}

void Recomputer::take(const can::RawSet& set) {
  const bool follows = lastSample_ && set.sample == static_cast<std::uint8_t>(*lastSample_ + 1);
  if (lastSample_ && !follows) {
    ++tally_.gaps;
    end();
  }
  lastSample_ = set.sample;
  if (set.zeroing && !wasZeroing_ && follows) begin();
  wasZeroing_ = set.zeroing;
  if (engine_ != nullptr)
    compute(set);
  else
    ++tally_.leftOut;
}

void Recomputer::begin() {
  end();
  engine_ = std::make_unique<Engine>(tables_, finger_);
  zeroingSets_ = 0;
}

void Recomputer::end() {
  engine_.reset();
  recorded_.clear();
  computed_.clear();
  firstSequence_.reset();
  before_.reset();
  hasSecond_ = false;
}

void Recomputer::compute(const can::RawSet& set) {
  zeroingSets_ += set.zeroing ? 1 : 0;
  ++tally_.sets;
  for (const CanFrame& frame : engine_->pass(set))
    if (isTouchOf(finger_.node, frame)) computed_[frame.id].push_back(frame);
  compareAll();
}

/// A touch that a tare was forced on ends after it, its second contact with the first frames of the next
/// touch: what began them is not known here.
bool Recomputer::isOfTouchBefore(const CanFrame& frame) {
  const auto second = decode<Contact2Frame>(frame);
  hasSecond_ |= second && second->flags.has(FingerFlag::kContact);
  if (!hasSecond_ && (second || decode<Force2Frame>(frame))) return true;
  const auto contact = decode<ContactFrame>(frame);
  if (contact && !firstSequence_) {
    before_.reset();
    if (contact->flags.has(FingerFlag::kContact))
      firstSequence_ = contact->sequence;
    else
      before_ = contact->sequence;
  }
  return !firstSequence_ || before_ == frame.data[kSequenceByte];
}

/// Frames of an identifier stay in order on the bus; between identifiers they don't.
void Recomputer::compareAll() {
  for (auto& [id, recorded] : recorded_) {
    auto& computed = computed_[id];
    while (!recorded.empty() && !computed.empty()) {
      const auto ahead = static_cast<std::int8_t>(recorded.front().frame.data[kSequenceByte] -
                                                  computed.front().data[kSequenceByte] - *firstSequence_);
      if (ahead > 0)
        ++tally_.absent;
      else
        compare(computed.front(), recorded.front());
      if (ahead >= 0) computed.pop_front();
      if (ahead <= 0) recorded.pop_front();
    }
  }
}

void Recomputer::compare(const CanFrame& computed, const Recorded& recorded) {
  ++tally_.compared;
  const CanFrame expected = adopted(computed, recorded.frame, finger_.node, *firstSequence_);
  if (expected == recorded.frame) return;
  ++tally_.different;
  if (!tally_.first)
    tally_.first =
        fmt::format("at {:.6f} s: recorded {}, computed {}", static_cast<double>(recorded.time_ns) * 1e-9,
                    hexOf(recorded.frame), hexOf(expected));
}

RecomputeTally Recomputer::finish() {
  end();
  return tally_;
}

}  // namespace strainfinger::recompute
