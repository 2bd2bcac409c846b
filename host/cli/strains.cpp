#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/frames.hpp"
#include "common/raw_share.hpp"
#include "host/base/failure.hpp"
#include "host/base/line_reader.hpp"
#include "host/base/notice.hpp"
#include "host/base/strain_rows.hpp"
#include "host/base/text_output.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/can/log_reader.hpp"
#include "host/can/one_finger.hpp"
#include "host/can/open_bus.hpp"
#include "host/can/remedies.hpp"
#include "host/can/strain_receiver.hpp"
#include "host/cli/bus_option.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/raw_stream.hpp"
#include "host/cli/request.hpp"
#include "host/system/stop_signal.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kStrainsHelp =
    "Asks a finger for its gauges' readings (RAW) and prints them as strains, a row a sample set, until "
    "there are --rows, its duration is over or Ctrl-C; then the finger is told to stop.\n"
    "FILE.. in place of --can: prints the readings that were recorded in logs (any candump text with times) "
    "while somebody had asked for them; those before a log's first zeros, which come once a second, are left "
    "out.\n"
    "stdout: time_s (since 1970, of arrival; of a log, as it has it), strain_0, strain_1 ..: as `locate`, "
    "`shape` and `calibrate` read them, at nominal gain and less the finger's zero.\n"
    "The config's gauges must be those of the finger. At the end stderr says how many sets came whole. Exit "
    "status: 1 refused, or no readings in the logs, 3 no interface, 4 no such node or no readings, 5 another "
    "ring's config.";

constexpr std::chrono::milliseconds kSilence{3000};  ///< longer than the slowest rate's period
constexpr double kLongestStrains_s = 1e6;
constexpr int kUsualRate_hz = 100;

struct StrainsOptions {
  explicit StrainsOptions(CLI::App& command) : common(command) {
    command.add_option("files", paths, "Logs with RAW in them, read in this order; - is stdin")
        ->type_name("FILE");
    addBusOption(command, bus);
    command.add_option("-n,--node", node, "Node number in place of the config's")->check(isNode());
    addInterfaceOption(command, part.interface);
    addWindowOptions(command, part.window);
    command.add_option("--rate", rate_hz, fmt::format("Sample sets a second (default {})", kUsualRate_hz))
        ->type_name("HZ")
        ->check(isWhole(1, int{kFastestRaw_hz}));
    command.add_option("--duration", duration_s, "Seconds; without it until Ctrl-C")
        ->type_name("S")
        ->check(isFrom(0.001, kLongestStrains_s));
    command.add_option("--rows", rows, "So many rows at most")->type_name("N")->check(isCount());
  }
  CommonOptions common;
  std::vector<std::string> paths;
  std::string bus;    ///< empty: the logs
  int node = 0;       ///< 0: the config's
  can::LogPart part;  ///< of the logs
  std::optional<int> rate_hz;
  std::optional<double> duration_s;
  std::uint64_t rows = std::numeric_limits<std::uint64_t>::max();
};

class StrainPrinter {
 public:
  StrainPrinter(const config::Gauges& gauges, TableFormat format)
      : format_(format), table_(stdout, format, columnsOf(gauges)) {}

  void print(std::int64_t time_ns, const can::StrainSet& set) {
    std::vector<Cell> cells{timeCell(time_ns)};
    cells.insert(cells.end(), set.strains.begin(), set.strains.end());
    table_.row(cells);
    table_.flush();
    ++sets_;
  }

  std::uint64_t sets() const { return sets_; }

 private:
  /// [s], to the microsecond, which is what a double holds of the time since 1970.
  Cell timeCell(std::int64_t time_ns) const {
    if (format_ == TableFormat::kJson) return 1e-6 * static_cast<double>(time_ns / 1000);
    return fmt::format("{}.{:06}", time_ns / 1'000'000'000, time_ns % 1'000'000'000 / 1000);
  }

  static std::vector<std::string> columnsOf(const config::Gauges& gauges) {
    std::vector<std::string> columns = strainColumns(gauges.count);
    columns.insert(columns.begin(), "time_s");
    return columns;
  }

  TableFormat format_;
  TableWriter table_;
  std::uint64_t sets_ = 0;
};

using StrainClock = std::chrono::steady_clock;

/// What tells why no whole sets come: whether a finger is alive and sends any, and what others told it.
class Circumstances {
 public:
  explicit Circumstances(std::uint8_t node) : node_(node) {}

  /// Takes any frame.
  void take(const CanFrame& frame) {
    if (nodeOf(frame.id, FunctionCode::kHeartbeat) == node_) {
      alive_ = StrainClock::now();
      if (const auto heartbeat = decode<HeartbeatFrame>(frame)) tableCrc_ = heartbeat->table_crc;
    }
    if (const auto request = readSingleFrame<RequestFrame>(frame, node_);
        request && changesRaw(request->command))
      othersCommand_ = request->command;
    if (nodeOf(frame.id, FunctionCode::kRaw) == node_) sent_ = StrainClock::now();
  }
  bool isSending() const { return isRecent(sent_); }
  bool isAlive() const { return isRecent(alive_); }
  /// Of another program, after which RAW ends or has another rate.
  std::optional<Command> othersCommand() const { return othersCommand_; }
  /// How the CRC-32 of its tables ends, once it was heard to say so.
  std::optional<std::uint8_t> tableCrc() const { return tableCrc_; }

 private:
  static bool isRecent(StrainClock::time_point time) { return StrainClock::now() - time < kSilence / 2; }
  static bool changesRaw(Command command) {
    return command == Command::kRaw || command == Command::kLoad || command == Command::kRestart;
  }

  std::uint8_t node_;
  StrainClock::time_point sent_{}, alive_{};
  std::optional<Command> othersCommand_{};
  std::optional<std::uint8_t> tableCrc_{};
};

/// What another program did; "" where none did.
std::string othersText(const Circumstances& finger) {
  if (!finger.othersCommand()) return "";
  return fmt::format("another program asked this finger, too ({}): {}",
                     can::nameText(kCommandNames, static_cast<int>(*finger.othersCommand())),
                     can::kOthersAskRemedy);
}

/// The config says by what the codes are multiplied: one that is not the finger's gives wrong strains.
void warnOfOtherTables(std::optional<std::uint8_t> tableCrc, const config::FingerConfig& config) {
  const auto wanted = tableCrcByte(tables::buildTableImage(config).crc32);
  if (!tableCrc || *tableCrc == wanted) return;
  warn("strains", fmt::format("the finger's tables are not those of {} (their CRC-32 ends with {:02X}, not "
                              "{:02X}): where gauges.full_scale_strain is another, all strains are off by as "
                              "much",
                              config.source, *tableCrc, wanted));
}

/// Why readings that came come no more.
std::string whyEnded(const Circumstances& finger, std::uint64_t sets, double waited_s) {
  if (!finger.isAlive())
    return fmt::format("silent for {} s after {} sets: is it off, or unplugged? What came is printed",
                       waited_s, sets);
  const std::string others = othersText(finger);
  return fmt::format("no readings for {} s after {} sets, though it is alive: {}. What came is printed",
                     waited_s, sets, others.empty() ? "it started anew meanwhile: ask it again" : others);
}

/// Why there is no whole set, or no further one, and what to do.
std::string whyNone(bool sendsAny, const Circumstances& finger, std::uint64_t sets, double waited_s) {
  if (sets > 0 && !finger.isSending()) return whyEnded(finger, sets, waited_s);
  if (!sendsAny) return fmt::format("no readings in {} s: is the bus free enough?", waited_s);
  return fmt::format(
      "no whole set of readings in {} s: is the bus free enough? A lower --rate or a longer "
      "--duration may help",
      waited_s);
}

/// What the logs of one finger say, row by row.
class LoggedStrains {
 public:
  LoggedStrains(const StrainsOptions& options, const config::FingerConfig& config)
      : options_(options),
        config_(config),
        node_(nodeOf(options.node, config.can)),
        one_(node_),
        printer_(config.gauges, options.common.format()) {}

  /// A log may begin anywhere: of the one before it nothing is known any more but which finger it is.
  void print(const std::string& path) {
    can::LogReader log(path, options_.part);
    can::StrainReceiver receiver(node_, config_.gauges.count, config_.gauges.full_scale_strain);
    while (!isWhole()) {
      const auto text = log.next();
      if (!text) break;
      one_.watch(path, *text);
      if (nodeOf(text->frame.id, FunctionCode::kHeartbeat) == node_) takeHeartbeat(path, text->frame);
      if (const auto set = receiver.take(text->frame)) printer_.print(*text->time_ns, *set);
    }
    warn("strains", log.warnings());
    log.requireAny();
    receiver.requireAllGauges();
    if (printer_.sets() == 0) receiver.requireEnoughGauges();
    incomplete_ += receiver.incomplete();
    withoutZeros_ += receiver.withoutZeros();
  }

  bool isWhole() const { return printer_.sets() >= options_.rows; }

  /// Throws Failure(kFailure) where there was no row.
  void finish() const {
    if (options_.common.hasConfig()) warnOfOtherTables(tableCrc_, config_);
    tell("strains: {} sets, {} incomplete, {} before the finger told its zeros\n", printer_.sets(),
         incomplete_, withoutZeros_);
    if (printer_.sets() == 0)
      throw Failure(ExitCode::kFailure,
                    fmt::format("strains: no readings (RAW) of node {} with their zeros, which come once a "
                                "second: record while `strainfinger strains --can ..` runs, or give -n",
                                node_));
  }

 private:
  void takeHeartbeat(const std::string& path, const CanFrame& frame) {
    const auto heartbeat = decode<HeartbeatFrame>(frame);
    if (!heartbeat) return;
    if (heartbeat->protocol != kProtocolVersion)
      throw Failure(ExitCode::kMismatch,
                    fmt::format("{}: node {} {}", path, node_, can::foreignText(heartbeat->protocol)));
    tableCrc_ = heartbeat->table_crc;
  }

  const StrainsOptions& options_;
  const config::FingerConfig& config_;
  std::uint8_t node_;
  can::OneFinger one_;
  StrainPrinter printer_;
  std::optional<std::uint8_t> tableCrc_;  ///< as Circumstances has it
  std::uint64_t incomplete_ = 0;
  std::uint64_t withoutZeros_ = 0;
};

void printLogs(const StrainsOptions& options) {
  if (options.rate_hz || options.duration_s)
    throw Failure(ExitCode::kUsage, "strains: --rate and --duration go with --can: a log has what it has");
  for (const std::string& path : options.paths)
    LineReader::requireReadable(path);  // nothing is printed if one is not there
  const config::FingerConfig& config = options.common.config();
  LoggedStrains strains(options, config);
  for (const std::string& path : options.paths)
    if (!strains.isWhole()) strains.print(path);
  strains.finish();
}

void printLive(const StrainsOptions& options) {
  if (!options.part.interface.empty() || !options.part.window.isWhole())
    throw Failure(ExitCode::kUsage,
                  "strains: --interface, --from and --to go with FILE: --can names the bus");
  const double duration_s = options.duration_s.value_or(kLongestStrains_s);
  const config::FingerConfig config = options.common.config();
  const std::uint8_t node = nodeOf(options.node, config.can);
  const auto bus = can::openBus(options.bus, config.can.bitrate);
  const system::StopSignal stop;
  RawStream stream(*bus, node, options.rate_hz.value_or(kUsualRate_hz), stop);
  const auto end = StrainClock::now() + std::chrono::microseconds(std::llround(duration_s * 1e6));
  can::StrainReceiver receiver(node, config.gauges.count, config.gauges.full_scale_strain);
  StrainPrinter printer(config.gauges, options.common.format());
  Circumstances finger(node);
  const auto giveUp = [&](double waited_s) {
    if (printer.sets() == 0) receiver.requireEnoughGauges();
    throw Failure(ExitCode::kNoNode,
                  fmt::format("{} node {}: {}", bus->name(), node,
                              whyNone(receiver.sendsAny(), finger, printer.sets(), waited_s)));
  };
  const auto isWhole = [&] { return printer.sets() >= options.rows; };
  for (auto heard = StrainClock::now(); !stop.asked() && !isWhole() && StrainClock::now() < end;) {
    bus->waitReadable(std::chrono::milliseconds(50));
    while (!isWhole()) {
      const auto arrived = bus->receiveTimed();
      if (!arrived) break;
      finger.take(arrived->frame);
      const auto set = receiver.take(arrived->frame);
      if (!set) continue;
      heard = StrainClock::now();
      printer.print(arrived->time_ns, *set);
    }
    receiver.requireAllGauges();
    if (StrainClock::now() - heard > kSilence) giveUp(kSilence.count() / 1e3);
  }
  if (options.common.hasConfig()) warnOfOtherTables(finger.tableCrc(), config);
  tell("strains: {} sets, {} incomplete\n", printer.sets(), receiver.incomplete());
  if (const std::string others = othersText(finger); !others.empty())
    tell("strains: {}: the rate may not be --rate\n", others);
  if (stop.asked()) throw Failure(ExitCode::kInterrupted, "strains: interrupted");
  if (printer.sets() == 0) giveUp(duration_s);
}

void runStrains(const StrainsOptions& options) {
  if (options.bus.empty() == options.paths.empty())
    throw Failure(ExitCode::kUsage, "strains: give either --can, to ask a finger, or FILE, a log of one");
  if (options.bus.empty()) return printLogs(options);
  printLive(options);
}

}  // namespace

void addStrains(CLI::App& app) { addCommand<StrainsOptions>(app, "strains", kStrainsHelp, runStrains); }

}  // namespace strainfinger::cli
