#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "host/base/failure.hpp"
#include "host/base/notice.hpp"
#include "host/can/open_bus.hpp"
#include "host/can/udp_port.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/listening.hpp"
#include "host/health/can_links.hpp"
#include "host/health/counts.hpp"
#include "host/health/examine.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger::cli {
namespace {

using health::Finding;
using health::Findings;
using health::Severity;

constexpr const char* kDoctorHelp =
    "Looks for what is wrong with fingers and their buses, and says what to do about it: interface, "
    "bit rate, controller, load, node numbers, protocol, faults, gauges, zeros, crashes, lost frames.\n"
    "Without --can every CAN interface of this machine. With -c also whether the config's node is there and "
    "has the config's tables. It listens, and asks fingers for their counts; it changes nothing.\n"
    "A line for each finding (ok, warning or error) with what to do below it; with --json an object "
    "result,where,finding,remedy.\n"
    "Exit status 0: no error; else that of the first error: 1, 3 no interface, 4 no finger, or one of "
    "--expect not, 5 another protocol or other tables.";

constexpr const char* kNotHeardRemedy =
    "is it powered, and has it this number? `strainfinger discover` lists those that are there";

struct DoctorOptions {
  explicit DoctorOptions(CLI::App& command)
      : common(command),
        listening(command, 1, 5, "two fingers of one number show in their INFOs, one a second") {
    addExpectOption(command, expected);
  }
  CommonOptions common;
  ListeningOptions listening;
  std::vector<int> expected;
};

/// Prints findings, and remembers the first error.
class Report {
 public:
  explicit Report(TableFormat format) {
    if (format == TableFormat::kJson)
      table_.emplace(stdout, format, std::vector<std::string>{"result", "where", "finding", "remedy"});
  }

  void add(const Findings& findings) {
    for (const Finding& finding : findings) {
      print(finding);
      warnings_ += finding.severity == Severity::kWarning ? 1 : 0;
      errors_ += finding.severity == Severity::kError ? 1 : 0;
      if (finding.severity == Severity::kError && status_ == ExitCode::kOk) status_ = finding.status;
    }
    std::fflush(stdout);
  }

  void end() const {
    const std::string sum = fmt::format("doctor: errors: {}, warnings: {}", errors_, warnings_);
    if (status_ != ExitCode::kOk) throw Failure(status_, sum);
    tell("{}\n", sum);
  }

 private:
  void print(const Finding& finding) {
    if (table_) return table_->row({nameOf(finding.severity), finding.where, finding.what, finding.remedy});
    fmt::print("{:8} {}: {}\n", nameOf(finding.severity), finding.where, finding.what);
    if (!finding.remedy.empty()) fmt::print("         what to do: {}\n", finding.remedy);
  }

  std::optional<TableWriter> table_;
  ExitCode status_ = ExitCode::kOk;
  int warnings_ = 0, errors_ = 0;
};

/// Of --can, or else all there are.
std::vector<health::CanLink> linksOf(const std::string& bus, Report& report) {
  if (can::isUdpName(bus)) return {};
  try {
    std::vector<health::CanLink> links = health::canLinks();
    if (!bus.empty()) std::erase_if(links, [&](const health::CanLink& link) { return link.name != bus; });
    if (bus.empty() && links.empty())
      report.add({{Severity::kError, "this machine", "there is no CAN interface",
                   "plug an adapter in (`ip -br link` shows it then); --can udp is a bus between the "
                   "programs of this machine",
                   ExitCode::kNoInterface}});
    return links;
  } catch (const Failure& failure) {
    report.add({{bus.empty() ? Severity::kError : Severity::kWarning, "this machine", failure.what()}});
    return {};
  }
}

/// Of several interfaces that nobody named, one that is down may not be in use.
Findings onlyWarning(Findings findings) {
  for (Finding& finding : findings) finding.severity = Severity::kWarning;
  return findings;
}

/// Without -c any bit rate will do: it is the interface's.
config::FingerConfig atRateOf(const health::CanLink& link, config::FingerConfig config) {
  if (link.bitrate) config.can.bitrate = *link.bitrate;
  return config;
}

void openBus(const std::string& name, const config::FingerConfig& config, std::vector<ListenedBus>& buses,
             Report& report) {
  try {
    buses.emplace_back(can::openBus(name, config.can.bitrate), config);
  } catch (const Failure& failure) {
    if (failure.code() == ExitCode::kUsage) throw;
    report.add({{Severity::kError, name, failure.what(), "", failure.code()}});
  }
}

/// The buses that can be listened to.
std::vector<ListenedBus> openBuses(const DoctorOptions& options, const config::FingerConfig& config,
                                   Report& report) {
  const std::string& bus = options.listening.bus;
  const std::vector<health::CanLink> links = linksOf(bus, report);
  const bool isAnyUp = std::ranges::any_of(links, &health::CanLink::isUp);
  std::vector<ListenedBus> buses;
  for (const health::CanLink& link : links) {
    const bool isGiven = options.common.hasConfig();
    const auto bitrate = isGiven ? std::optional(config.can.bitrate) : std::nullopt;
    const Findings findings = health::examineLink(link, bitrate);
    report.add(bus.empty() && isAnyUp && !link.isUp ? onlyWarning(findings) : findings);
    if (link.isUp) openBus(link.name, isGiven ? config : atRateOf(link, config), buses, report);
  }
  if (!bus.empty() && links.empty()) openBus(bus, config, buses, report);
  return buses;
}

/// With -c: the finger that it is of.
class Expected {
 public:
  Expected(const CommonOptions& options, const config::FingerConfig& config) {
    if (!options.hasConfig()) return;
    node_ = config.can.node;
    crc32_ = tables::buildTableImage(config).crc32;
  }
  std::optional<std::uint32_t> tablesOf(const live::FingerView& finger) const {
    return finger.node == node_ ? crc32_ : std::nullopt;
  }
  /// An error, where it is on none of the buses.
  Findings findingsOn(std::span<const live::BusView> buses) const {
    const auto has = [&](const live::BusView& bus) {
      return std::ranges::count(bus.fingers, node_, &live::FingerView::node) > 0;
    };
    const bool areAllSilent =
        std::ranges::all_of(buses, [](const live::BusView& bus) { return bus.fingers.empty(); });
    if (!crc32_ || areAllSilent || std::ranges::any_of(buses, has)) return {};
    return {{Severity::kError, "config", fmt::format("its node {} (can.node) is not heard", node_),
             kNotHeardRemedy, ExitCode::kNoNode}};
  }

 private:
  int node_ = 0;
  std::optional<std::uint32_t> crc32_;
};

void examineFingers(ListenedBus& bus, const live::BusView& view, const Expected& expected, Report& report) {
  for (const live::FingerView& finger : view.fingers) {
    report.add(health::examineFinger(view.name, finger, expected.tablesOf(finger)));
    if (health::canAnswer(finger))
      report.add(health::examineCounts(view.name, finger.node, health::askForCounts(bus.port(), finger.node),
                                       bus.port().hints()));
  }
}

void runDoctor(const DoctorOptions& options) {
  const config::FingerConfig config = options.common.config();
  const Expected expected(options.common, config);
  Report report(options.common.format());
  std::vector<ListenedBus> buses = openBuses(options, config, report);
  const std::vector<live::BusView> views = listenTo(buses, options.listening.duration(), "doctor");
  for (std::size_t i = 0; i < buses.size(); ++i) {
    report.add(health::examineBus(views[i], buses[i].port().status().state, buses[i].port().hints(),
                                  options.listening.duration()));
    examineFingers(buses[i], views[i], expected, report);
  }
  report.add(expected.findingsOn(views));
  for (const int node : missingOf(options.expected, views))
    report.add({{Severity::kError, "--expect", fmt::format("node {} is not heard", node), kNotHeardRemedy,
                 ExitCode::kNoNode}});
  report.end();
}

}  // namespace

void addDoctor(CLI::App& app) { addCommand<DoctorOptions>(app, "doctor", kDoctorHelp, runDoctor); }

}  // namespace strainfinger::cli
