#pragma once
// What screens show of the fingers on a bus: values, without a word of how they look.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/frames.hpp"
#include "hal/can_port.hpp"
#include "host/base/no_value.hpp"
#include "host/can/touch_receiver.hpp"

namespace strainfinger::live {

/// Where the forces of all touches between two views lay: a tap shorter than the time between these is seen.
struct ForceSpan {
  double leastNormal_n = kNoValue, mostNormal_n = kNoValue;
  double leastTangential_n = kNoValue, mostTangential_n = kNoValue;
};

/// A finger, that is a node whose HEARTBEAT was heard, at one moment.
struct FingerView {
  std::string bus{};  ///< "can0"
  std::uint8_t node = 0;
  std::int64_t silence_us = 0;  ///< since its last HEARTBEAT
  HeartbeatFrame heartbeat{};   ///< the last
  std::optional<InfoFrame> info{};
  std::optional<GaugesFrame> gauges{};
  /// The last; none before the first, none of a finger that is silent or speaks another protocol, and none
  /// that says "touched" and was not confirmed in time: an old value is never shown as a new one.
  std::optional<can::TouchReport> touch{};
  std::int64_t touched_us = 0;  ///< when that was complete, on the clock of the view
  std::int64_t since_us = 0;    ///< when the first was that says "touched" as that one does, or doesn't
  /// What its gauges read by its newest RAW, less their zeros; empty where none came in the last 1.5 s.
  std::vector<double> strains{};
  double rawLoad = 0;            ///< share of the bit rate that its RAW took over the last second
  std::vector<double> fitted{};  ///< what they should read under that touch; empty: not worked out
  ForceSpan span{};
  double strongest_n = 0;               ///< largest force so far, of either direction: to scale a bar by
  std::uint64_t contactsPerSecond = 0;  ///< CONTACT frames over the last second
  /// How far the intervals between its last ten HEARTBEATs were from the ten a second they should be, at
  /// most.
  double jitter_s = kNoValue;
  std::uint64_t received = 0;  ///< frames of touches
  std::uint64_t lost = 0;      ///< of these, by their sequence numbers
  std::uint64_t restarts = 0;
  bool hasTwin = false;  ///< another finger has its node number: touches are of either, counts mean nothing
  bool hasOtherTables = false;  ///< than the config's; false where that is not known

  /// Nothing heard for the time of five HEARTBEATs.
  bool isSilent() const { return silence_us > 5'000 * std::int64_t{kHeartbeatPeriod_ms}; }
  bool isForeign() const { return heartbeat.protocol != kProtocolVersion; }
  bool isTouched() const { return touch && touch->flags.has(FingerFlag::kContact); }
};

struct BusView {
  std::string name;                              ///< "can0"
  hal::CanState state = hal::CanState::kActive;  ///< of this machine's controller; a log's: active
  std::int64_t time_us = 0;                      ///< of the view, on the clock of the frames: OnwardClock
  std::uint64_t framesPerSecond = 0;             ///< of anybody and any format, over the last second
  double load = 0;           ///< share of the bit rate that these took, without stuff bits: BUS_LOAD.md
  std::uint32_t missed = 0;  ///< frames that this program was too slow for, as far as its port tells
  std::vector<FingerView> fingers{};  ///< by node
};

}  // namespace strainfinger::live
