#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "common/commands.hpp"
#include "host/base/failure.hpp"
#include "host/base/no_value.hpp"
#include "host/base/notice.hpp"
#include "host/can/field_text.hpp"
#include "host/can/open_bus.hpp"
#include "host/can/remedies.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/field_row.hpp"
#include "host/cli/request.hpp"
#include "host/health/counts.hpp"
#include "host/health/examine.hpp"
#include "host/live/bus_watch.hpp"
#include "host/system/stop_signal.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kInfoHelp =
    "What a finger tells of itself: state, faults, firmware, why it started, what the run before died of, "
    "gauges out of use, age of its zeros, and what it counts.\n"
    "Prints interface,node,frame,field,value,meaning; a value that it doesn't know is empty. With -c also "
    "whether its tables are those of that config: exit status 5 if not.\n"
    "Exit status: 1 two fingers have this node number, 3 no interface, 4 no such node, 5 another protocol or "
    "other tables.";

/// INFO and GAUGES come each second.
constexpr std::chrono::milliseconds kListenFor{2 * std::max(kInfoPeriod_ms, kGaugesPeriod_ms)};

std::optional<live::FingerView> fingerOf(const live::BusView& bus, std::uint8_t node) {
  const auto finger = std::ranges::find(bus.fingers, node, &live::FingerView::node);
  return finger != bus.fingers.end() ? std::optional(*finger) : std::nullopt;
}

/// Listens until it has said everything, or for as long as that should take; nothing: it is not heard.
std::optional<live::FingerView> listenFor(live::BusWatch& watch, std::uint8_t node) {
  using Clock = std::chrono::steady_clock;
  const system::StopSignal stop;
  const Clock::time_point end = Clock::now() + kListenFor;
  std::optional<live::FingerView> finger;
  while (Clock::now() < end && !(finger && finger->info && finger->gauges)) {
    watch.listen(system::StopSignal::kLookEvery);
    if (stop.asked()) throw Failure(ExitCode::kInterrupted, "info: interrupted");
    finger = fingerOf(watch.view(), node);
  }
  return finger;
}

/// By what was heard or by who answers.
bool hasTwin(can::BusPort& bus, const live::FingerView& finger) {
  if (finger.hasTwin || finger.isSilent()) return finger.hasTwin;
  return can::askWhoIsThere(bus, finger.node).hasTwin();
}

std::string textOf(const health::Finding& finding) {
  return fmt::format("{}: {}{}{}", finding.where, finding.what, finding.remedy.empty() ? "" : ": ",
                     finding.remedy);
}

/// Beside the table what is wrong: else an empty value, or an old one, would look like any other.
void tellErrorsOf(const health::Findings& findings) {
  for (const health::Finding& finding : findings)
    if (finding.severity == health::Severity::kError) tell("strainfinger: {}\n", textOf(finding));
}

/// What is wrong with the finger; throws Failure for what ends with a status of its own.
void tellOf(const health::Findings& findings) {
  const auto isEnding = [](const health::Finding& finding) {
    return finding.severity == health::Severity::kError && finding.status != ExitCode::kFailure;
  };
  health::Findings others = findings;
  const auto ending = std::ranges::find_if(findings, isEnding);
  if (ending != findings.end()) others.erase(others.begin() + (ending - findings.begin()));
  tellErrorsOf(others);
  if (ending != findings.end()) throw Failure(ending->status, textOf(*ending));
}

class InfoTable {
 public:
  InfoTable(const RequestOptions& options, std::uint8_t node)
      : bus_(options.bus), node_(node), table_(stdout, options.common.format(), columns()) {}

  template <typename Frame>
  void add(const Frame& frame) {
    const CanFrame encoded = encode(frame, node_);
    const can::FrameEntry& entry = *can::findFrame(encoded);
    for (const can::FieldValue& value : can::fieldValues(entry, encoded))
      add(entry.spec.name, fieldRow(value));
  }

  void add(Count count, std::optional<std::uint32_t> told) {
    const ValueName& name = *can::findName(kCountNames, static_cast<int>(count));
    Cell value = kNoValue;
    if (told) value = std::int64_t{*told};
    add(kLayout<ResponseFrame>.spec.name, {name.name, value, name.comment});
  }

 private:
  static std::vector<std::string> columns() {
    std::vector<std::string> columns{"interface", "node", "frame"};
    columns.insert(columns.end(), kFieldColumns.begin(), kFieldColumns.end());
    return columns;
  }
  void add(const char* frame, const std::vector<Cell>& field) {
    std::vector<Cell> row{bus_, std::int64_t{node_}, frame};
    row.insert(row.end(), field.begin(), field.end());
    table_.row(row);
  }

  std::string bus_;
  std::uint8_t node_;
  TableWriter table_;
};

/// Empty where it can't be asked, which the findings on it tell.
void addCounts(can::BusPort& port, const live::FingerView& finger, InfoTable& table) {
  if (!health::canAnswer(finger)) {
    for (const ValueName& name : kCountNames) table.add(Count{name.value}, std::nullopt);
    return;
  }
  const std::vector<health::Counted> counts = health::askForCounts(port, finger.node);
  for (const auto& [count, answer, value] : counts)
    table.add(count, answer == health::CountAnswer::kTold ? std::optional(value) : std::nullopt);
  tellErrorsOf(health::examineCounts(port.name(), finger.node, counts, port.hints()));
}

void runInfo(const RequestOptions& options) {
  const config::FingerConfig config = options.common.config();
  const std::uint8_t node = nodeOf(options.node, config.can);
  const auto port = can::openBus(options.bus, config.can.bitrate);
  live::BusWatch watch(*port, config);
  const auto finger = listenFor(watch, node);
  const std::string where = fmt::format("{} node {}", port->name(), node);
  if (!finger)
    throw Failure(ExitCode::kNoNode,
                  fmt::format("{}: no HEARTBEAT in {} ms: {} `strainfinger discover --can {}` shows "
                              "the fingers that are there",
                              where, kListenFor.count(), port->hints().whenSilent, port->name()));
  if (finger->isForeign())
    throw Failure(ExitCode::kMismatch,
                  fmt::format("{}: {}", where, can::foreignText(finger->heartbeat.protocol)));
  if (hasTwin(*port, *finger)) throw twinFailure(*port, node);
  InfoTable table(options, node);
  table.add(finger->heartbeat);
  if (finger->info) table.add(*finger->info);
  if (finger->gauges) table.add(*finger->gauges);
  addCounts(*port, *finger, table);
  std::optional<std::uint32_t> crc32;
  if (options.common.hasConfig()) crc32 = tables::buildTableImage(config).crc32;
  tellOf(health::examineFinger(port->name(), *finger, crc32));
}

}  // namespace

void addInfo(CLI::App& app) { addCommand<RequestOptions>(app, "info", kInfoHelp, runInfo); }

}  // namespace strainfinger::cli
