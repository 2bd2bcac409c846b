#include "host/health/examine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "common/raw_share.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/can/other_tables.hpp"
#include "host/can/remedies.hpp"
#include "host/can/socketcan_port.hpp"
#include "host/config/bus_load.hpp"
#include "host/live/value_text.hpp"
#include "host/live/words.hpp"

namespace strainfinger::health {
namespace {

/// Of the bit rate, without stuff bits: with as many of these as there can be the bus is full.
constexpr double kMostLoad = double{kFrameBits} / config::kWorstFrame_bits;

/// ISO 11898's error warning and error passive.
constexpr int kErrorWarning = 96, kErrorPassive = 128;

/// Of an adapter, as parts of a bit (firmware/bring_up.md), and what it may be off them by rounding.
constexpr double kEarliestSample = 0.75, kLatestSample = 0.875, kSampleRounding = 0.005;

/// Of a zero: from here on touches may be reported that are none (firmware/limits.md).
constexpr std::uint16_t kFastDrift_nano_per_s = 1000;

/// Erases of the settings' memory from which on its end is near.
constexpr std::uint32_t kNearlyWorn = can::kWornOut_erases / 10 * 9;

constexpr std::string_view kBusRemedy =
    "check the bus: wiring, 120 ohm at both ends, one bit rate for all, somebody who acknowledges";

/// Flags of a touch that somebody should know of.
constexpr std::array kNotableFlags{FingerFlag::kSaturated, FingerFlag::kDegraded, FingerFlag::kUncertain,
                                   FingerFlag::kStaleZero, FingerFlag::kUncalibrated};

/// Faults with which its touches are not told, or not to be trusted.
constexpr std::array kEndingFaults{FingerFault::kTables, FingerFault::kGauges, FingerFault::kConverter};

/// Gathers findings about one thing.
class Examination {
 public:
  explicit Examination(std::string bus) : bus_(std::move(bus)), where_(bus_) {}
  Examination(std::string bus, std::uint8_t node)
      : bus_(std::move(bus)), where_(fmt::format("{} node {}", bus_, node)), node_(node) {}

  void good(std::string what) { add(Severity::kGood, std::move(what), ""); }
  void warning(std::string what, std::string_view remedy) {
    add(Severity::kWarning, std::move(what), remedy);
  }
  void error(std::string what, std::string_view remedy, ExitCode status = ExitCode::kFailure) {
    add(Severity::kError, std::move(what), remedy);
    findings_.back().status = status;
  }
  bool isEmpty() const { return findings_.empty(); }
  Findings findings() { return std::move(findings_); }

 private:
  void add(Severity severity, std::string what, std::string_view remedy) {
    findings_.push_back({severity, where_, std::move(what),
                         node_ ? can::forNode(remedy, bus_, *node_) : can::onBus(remedy, bus_)});
  }
  std::string bus_, where_;
  std::optional<std::uint8_t> node_;  ///< nothing: it is about a bus
  Findings findings_;
};

std::string bringUpAnew(const CanLink& link, int bitrate) {
  return fmt::format("`sudo ip link set {} down && {}`", link.name, can::bringUpCommand(link.name, bitrate));
}

std::string errorsOf(const CanLink& link) {
  if (!link.txErrors || !link.rxErrors) return "";
  return fmt::format("; its error counters: sent {}, received {}", *link.txErrors, *link.rxErrors);
}

void examineController(const CanLink& link, Examination& examination) {
  if (link.state == "BUS-OFF")
    examination.error("the controller has left the bus (bus-off) after too many errors",
                      link.restart_ms == 0 ? fmt::format("{}; then `sudo ip link set {} type can restart`",
                                                         kBusRemedy, link.name)
                                           : fmt::format("{}; it comes back by itself", kBusRemedy));
  else if (link.state == "ERROR-PASSIVE")
    examination.error("error-passive: frames are not acknowledged or not understood" + errorsOf(link),
                      kBusRemedy);
  else if (link.state == "ERROR-WARNING")
    examination.warning("many errors on the bus" + errorsOf(link), kBusRemedy);
}

std::string describe(const CanLink& link) {
  if (link.state.empty()) return "up; a virtual interface, or one that tells nothing of its controller";
  std::string text = "up, " + link.state;
  if (link.bitrate) text += fmt::format(", {} bit/s", *link.bitrate);
  if (link.samplePoint) text += fmt::format(", sample point {:.1f} %", 100 * *link.samplePoint);
  return text;
}

/// "fault noisy: The untouched gauges ..."
template <std::size_t N>
std::string said(const char* kind, const std::array<ValueName, N>& names, int value) {
  const ValueName* const name = can::findName(names, value);
  return fmt::format("{} {}: {}", kind, live::wordFor(names, value),
                     name != nullptr ? name->comment : "unknown to this program");
}

void examineHeartbeat(const HeartbeatFrame& heartbeat, Examination& examination) {
  const auto faults = live::bitNumbers(heartbeat.faults.raw());
  for (const int bit : faults) {
    const auto fault = static_cast<FingerFault>(bit);
    const std::string what = said("fault", kFingerFaultNames, bit);
    if (std::ranges::find(kEndingFaults, fault) != kEndingFaults.end())
      examination.error(what, can::remedyFor(fault),
                        fault == FingerFault::kTables ? ExitCode::kMismatch : ExitCode::kFailure);
    else
      examination.warning(what, can::remedyFor(fault));
  }
  if (heartbeat.state != FingerState::kRun && faults.empty())
    examination.warning(said("state", kFingerStateNames, static_cast<int>(heartbeat.state)),
                        can::remedyFor(heartbeat.state));
  int errors = 0;
  for (const std::uint8_t steps : {heartbeat.tx_error_steps, heartbeat.rx_error_steps})
    if (steps != kErrorStepsNotKnown) errors = std::max(errors, steps * kErrorsPerStep);
  if (errors >= kErrorPassive)
    examination.error("its CAN controller is error-passive", kBusRemedy);
  else if (errors >= kErrorWarning)
    examination.warning("its CAN controller has seen many errors", kBusRemedy);
}

void examineTables(const HeartbeatFrame& heartbeat, std::uint32_t crc32, Examination& examination) {
  if (!can::hasOtherTables(heartbeat, crc32)) return;
  examination.error(
      fmt::format("its tables are not those of the config: their CRC-32 ends with {:02X}, not {:02X}",
                  heartbeat.table_crc, tableCrcByte(crc32)),
      "give the config that its tables were made from (-c), or send it those of this one: `strainfinger push "
      "--can BUS -n N -c FINGER.toml`",
      ExitCode::kMismatch);
}

void examineInfo(const InfoFrame& info, Examination& examination) {
  if (info.crash != Crash::kNone)
    examination.warning(
        fmt::format("{}{}; crashes since power came on: {}",
                    said("crash of the run before,", kCrashNames, static_cast<int>(info.crash)),
                    info.crash_address == 0 ? "" : fmt::format(", at 0x{:X}", info.crash_address),
                    info.restarts),
        can::remedyFor(info.crash));
  if (info.reset_cause == ResetCause::kBrownOut)
    examination.warning(said("last reset", kResetCauseNames, static_cast<int>(info.reset_cause)),
                        can::remedyFor(info.reset_cause));
}

void examineTraffic(const live::FingerView& finger, Examination& examination) {
  if (finger.lost > 0)
    examination.warning(fmt::format("{} of {} frames of touches were lost on the way", finger.lost,
                                    finger.lost + finger.received),
                        "is the bus too full (common/BUS_LOAD.md), or a program on it too slow?");
  if (finger.rawLoad > 0)
    examination.warning(
        fmt::format("it sends its gauges' readings (RAW), {:.1f} % of the bit rate", 100 * finger.rawLoad),
        "if nobody reads them, `strainfinger strains --can BUS -n N --rows 1` ends that");
  if (finger.restarts > 0)
    examination.warning(
        "its uptime went back: it restarted, or two fingers have this node number",
        "measure its supply; `strainfinger doctor --can BUS --duration 10` tells two fingers apart");
  if (finger.touch)
    for (const FingerFlag flag : kNotableFlags)
      if (finger.touch->flags.has(flag))
        examination.warning(said("flag", kFingerFlagNames, static_cast<int>(flag)), can::remedyFor(flag));
}

void examineZeros(const GaugesFrame& gauges, Examination& examination) {
  if (gauges.zero_rate_nano_per_s == kNotKnown<std::uint16_t> ||
      gauges.zero_rate_nano_per_s < kFastDrift_nano_per_s)
    return;
  examination.warning(
      fmt::format("its zeros drift by {:.2g} microstrain a second: touches may be reported that are none",
                  1e-3 * gauges.zero_rate_nano_per_s),
      "let it warm up, keep warm and cold things away from it; if it goes on, gauges or their amplifiers are "
      "coming loose; `strainfinger tare --can BUS -n N` once it is quiet");
}

std::string describe(const live::FingerView& finger) {
  const HeartbeatFrame& heartbeat = finger.heartbeat;
  std::string text = fmt::format("{}, up {}, tables ..{:02X}",
                                 live::wordFor(kFingerStateNames, static_cast<int>(heartbeat.state)),
                                 live::durationText(heartbeat.uptime_s), heartbeat.table_crc);
  if (finger.info)
    text += fmt::format(", firmware {}.{}", finger.info->version_major, finger.info->version_minor);
  if (heartbeat.temperature_degC != kNotKnown<std::int8_t>)
    text += fmt::format(", {} degC", heartbeat.temperature_degC);
  if (finger.touch)
    text += finger.isTouched() ? fmt::format(", touched ({} contacts a second)", finger.contactsPerSecond)
                               : ", untouched";
  return text;
}

}  // namespace

const char* nameOf(Severity severity) {
  switch (severity) {
    case Severity::kGood:
      return "ok";
    case Severity::kWarning:
      return "warning";
    case Severity::kError:
      break;
  }
  return "error";
}

Findings examineLink(const CanLink& link, std::optional<int> bitrate) {
  Examination examination(link.name);
  const int wanted = bitrate.value_or(link.bitrate.value_or(config::Can{}.bitrate));
  if (!link.isUp) {
    examination.error("down", fmt::format("`{}`", can::bringUpCommand(link.name, wanted)),
                      ExitCode::kNoInterface);
    return examination.findings();
  }
  examineController(link, examination);
  if (link.bitrate && *link.bitrate != wanted)
    examination.error(fmt::format("{} bit/s; the config's can.bitrate is {}", *link.bitrate, wanted),
                      fmt::format("{}, or mend can.bitrate", bringUpAnew(link, wanted)));
  if (link.samplePoint && (*link.samplePoint < kEarliestSample - kSampleRounding ||
                           *link.samplePoint > kLatestSample + kSampleRounding))
    examination.warning(
        fmt::format("bits are sampled at {:.1f} % of their length; {} to {} % goes with the finger's 83.3",
                    100 * *link.samplePoint, 100 * kEarliestSample, 100 * kLatestSample),
        fmt::format("add `sample-point 0.8` to {}", bringUpAnew(link, wanted)));
  if (link.isListenOnly)
    examination.warning("listen-only: it acknowledges nothing, and no request can be sent",
                        fmt::format("add `listen-only off` to {}", bringUpAnew(link, wanted)));
  if (link.restart_ms == 0)
    examination.warning("a controller that leaves the bus stays off it (restart-ms 0)",
                        bringUpAnew(link, wanted));
  if (examination.isEmpty()) examination.good(describe(link));
  return examination.findings();
}

Findings examineBus(const live::BusView& bus, hal::CanState state, const can::BusHints& hints,
                    std::chrono::milliseconds listened) {
  Examination examination(bus.name);
  if (state == hal::CanState::kDown || state == hal::CanState::kBusOff)
    examination.error(
        state == hal::CanState::kDown ? "went down meanwhile" : "left the bus meanwhile (bus-off)",
        hints.whenBlocked, ExitCode::kNoInterface);
  if (bus.fingers.empty())
    examination.error(
        fmt::format("no finger heard in {:.1f} s, {}", static_cast<double>(listened.count()) / 1e3,
                    bus.framesPerSecond > 0 ? "though others send" : "and nothing else"),
        hints.whenSilent, ExitCode::kNoNode);
  if (bus.load > kMostLoad)
    examination.warning(
        fmt::format("{:.0f} % of the bit rate are used: with stuff bits the bus may be full", 100 * bus.load),
        "end RAW (`strainfinger strains --can BUS -n N --rows 1`), or lower contact rates: `strainfinger "
        "config --can BUS -n N --contact-rate-hz HZ` (common/BUS_LOAD.md)");
  if (bus.missed > 0)
    examination.warning(fmt::format("this machine was too slow for {} frames", bus.missed),
                        "what else does it do? lost frames may be its own");
  if (examination.isEmpty())
    examination.good(fmt::format("fingers: {}, frames a second: {}, {:.1f} % of the bit rate",
                                 bus.fingers.size(), bus.framesPerSecond, 100 * bus.load));
  return examination.findings();
}

bool canAnswer(const live::FingerView& finger) {
  return !finger.isSilent() && !finger.isForeign() && !finger.hasTwin &&
         finger.heartbeat.state != FingerState::kFault;
}

Findings examineFinger(const std::string& bus, const live::FingerView& finger,
                       std::optional<std::uint32_t> tables_crc32) {
  Examination examination(bus, finger.node);
  if (finger.isForeign()) {
    examination.error(can::foreignText(finger.heartbeat.protocol), "", ExitCode::kMismatch);
    return examination.findings();
  }
  if (finger.hasTwin)
    examination.error(fmt::format("{}: what they say is mixed up", can::kTwinText), can::kTwinRemedy);
  if (finger.isSilent())
    examination.error(fmt::format("silent for {:.1f} s", static_cast<double>(finger.silence_us) / 1e6),
                      "is it powered, and its plug in?", ExitCode::kNoNode);
  examineHeartbeat(finger.heartbeat, examination);
  if (tables_crc32) examineTables(finger.heartbeat, *tables_crc32, examination);
  if (finger.info) examineInfo(*finger.info, examination);
  if (finger.gauges) examineZeros(*finger.gauges, examination);
  const auto gauges = live::bitNumbers(finger.gauges ? finger.gauges->out_of_use : 0);
  if (!gauges.empty())
    examination.warning(
        fmt::format("gauges out of use: {}", fmt::join(gauges, ", ")),
        "check their wires (firmware/gauge_faults.md); `strainfinger tare --can BUS -n N` gives "
        "each another chance");
  if (!finger.hasTwin) examineTraffic(finger, examination);
  if (examination.isEmpty()) examination.good(describe(finger));
  return examination.findings();
}

Findings examineCounts(const std::string& bus, std::uint8_t node, std::span<const Counted> counts,
                       const can::BusHints& hints) {
  Examination examination(bus, node);
  for (const Counted& counted : counts) {
    const Count count = counted.count;
    if (counted.answer == CountAnswer::kNotSent) {
      examination.error("the bus takes no request to it", hints.whenBlocked, ExitCode::kNoInterface);
      break;
    }
    if (counted.answer == CountAnswer::kSilence) {
      examination.error("it is heard, but answers no request", "is its firmware older than this program?",
                        ExitCode::kNoNode);
      break;
    }
    if (counted.value > (count == Count::kErases ? kNearlyWorn - 1 : 0))
      examination.warning(
          fmt::format("{} {}", counted.value, said("counted", kCountNames, static_cast<int>(count))),
          can::remedyFor(count));
  }
  if (const auto doubtful = std::ranges::count(counts, CountAnswer::kOthersAsk, &Counted::answer);
      doubtful > 0)
    examination.warning(
        fmt::format("{} of its counts could not be told: another program asks it, too", doubtful),
        can::kOthersAskRemedy);
  if (examination.isEmpty()) examination.good("answers requests, and counts nothing that would be wrong");
  return examination.findings();
}

}  // namespace strainfinger::health
