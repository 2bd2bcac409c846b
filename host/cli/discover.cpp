#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "host/base/failure.hpp"
#include "host/base/no_value.hpp"
#include "host/base/notice.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/can/open_bus.hpp"
#include "host/can/remedies.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/listening.hpp"
#include "host/health/can_links.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kDiscoverHelp =
    "Which fingers are there: a row for each that is heard, by its HEARTBEAT. It sends nothing.\n"
    "Without --can on every CAN interface of this machine that is up.\n"
    "Prints interface,node,state,faults,protocol,firmware,board,reset_cause,uptime_s,table_crc,note; empty "
    "where the finger didn't say. table_crc is how the CRC-32 of its tables ends, as `tables info` prints "
    "it.\n"
    "Exit status: 3 no interface, 4 no finger heard, or one of --expect not.";

const std::vector<std::string> kColumns{"interface", "node",      "state", "faults",
                                        "protocol",  "firmware",  "board", "reset_cause",
                                        "uptime_s",  "table_crc", "note"};

struct DiscoverOptions {
  explicit DiscoverOptions(CLI::App& command)
      : common(command), listening(command, 0.1, 3, "two fingers of one number show by then") {
    addExpectOption(command, expected);
  }
  CommonOptions common;
  ListeningOptions listening;
  std::vector<int> expected;
};

std::string noteOn(const live::FingerView& finger) {
  if (finger.isForeign()) return can::foreignText(finger.heartbeat.protocol);
  if (finger.hasTwin) return std::string(can::kTwinText);
  return finger.isSilent() ? "silent" : "";
}

std::vector<Cell> rowOf(const live::BusView& bus, const live::FingerView& finger) {
  const HeartbeatFrame& heartbeat = finger.heartbeat;
  Cell state, faults, firmware, board, cause, uptime, tables;
  for (Cell* const unknown : {&state, &faults, &firmware, &board, &cause, &uptime, &tables})
    *unknown = kNoValue;
  if (!finger.isForeign()) {  // else the fields may mean something else
    state = can::nameText(kFingerStateNames, static_cast<int>(heartbeat.state));
    faults = can::flagsText(kFingerFaultNames, heartbeat.faults.raw());
    tables = fmt::format("{:02X}", heartbeat.table_crc);
    if (heartbeat.uptime_s != kNotKnown<std::uint16_t>) uptime = std::int64_t{heartbeat.uptime_s};
  }
  if (!finger.isForeign() && finger.info) {
    firmware = fmt::format("{}.{}", finger.info->version_major, finger.info->version_minor);
    board = std::int64_t{finger.info->board};
    cause = can::nameText(kResetCauseNames, static_cast<int>(finger.info->reset_cause));
  }
  return {bus.name,
          std::int64_t{finger.node},
          state,
          faults,
          std::int64_t{heartbeat.protocol},
          firmware,
          board,
          cause,
          uptime,
          tables,
          noteOn(finger)};
}

/// That of --can, or all CAN interfaces that are up.
std::vector<std::string> busNames(const ListeningOptions& options) {
  if (!options.bus.empty()) return {options.bus};
  std::vector<std::string> names;
  for (const health::CanLink& link : health::canLinks())
    if (link.isUp) names.push_back(link.name);
  if (names.empty())
    throw Failure(
        ExitCode::kNoInterface,
        "discover: no CAN interface of this machine is up: `strainfinger doctor` says how to bring one up; "
        "--can udp is a bus between the programs of this machine");
  return names;
}

/// One of several that can't be opened doesn't keep the others from being listened to.
std::vector<ListenedBus> openAll(const std::vector<std::string>& names, const config::FingerConfig& config) {
  std::vector<ListenedBus> buses;
  std::optional<Failure> failure;
  for (const std::string& name : names) try {
      buses.emplace_back(can::openBus(name, config.can.bitrate), config);
    } catch (const Failure& each) {
      if (names.size() > 1) tell("strainfinger: {}\n", each.what());
      failure = each;
    }
  if (buses.empty()) throw *failure;
  return buses;
}

/// At the end, too, one of several doesn't hide the fingers of the others.
void requireUp(std::vector<ListenedBus>& buses) {
  std::vector<std::string> down;
  for (ListenedBus& bus : buses)
    if (bus.port().status().state == hal::CanState::kDown)
      down.push_back(fmt::format("discover: {} went down meanwhile: {}", bus.port().name(),
                                 bus.port().hints().whenBlocked));
  if (down.size() == buses.size()) throw Failure(ExitCode::kNoInterface, down.front());
  for (const std::string& text : down) tell("strainfinger: {}\n", text);
}

void runDiscover(const DiscoverOptions& options) {
  const config::FingerConfig config = options.common.config();
  const std::vector<std::string> names = busNames(options.listening);
  std::vector<ListenedBus> buses = openAll(names, config);
  std::optional<TableWriter> table;  // nothing is printed before there is a row
  const std::vector<live::BusView> views = listenTo(buses, options.listening.duration(), "discover");
  requireUp(buses);
  for (const live::BusView& bus : views)
    for (const live::FingerView& finger : bus.fingers) {
      if (!table) table.emplace(stdout, options.common.format(), kColumns);
      table->row(rowOf(bus, finger));
    }
  if (!table)
    throw Failure(
        ExitCode::kNoNode,
        fmt::format("discover: no finger heard on {} in {} s: `strainfinger doctor{}` looks for the cause",
                    fmt::join(names, ", "), options.listening.duration_s,
                    names.size() == 1 ? fmt::format(" --can {}", names.front()) : ""));
  if (const std::vector<int> missing = missingOf(options.expected, views); !missing.empty())
    throw Failure(ExitCode::kNoNode,
                  fmt::format("discover: not heard: node {} (--expect)", fmt::join(missing, ", ")));
}

}  // namespace

void addDiscover(CLI::App& app) { addCommand<DiscoverOptions>(app, "discover", kDiscoverHelp, runDiscover); }

}  // namespace strainfinger::cli
