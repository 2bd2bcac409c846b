#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "host/base/failure.hpp"
#include "host/base/notice.hpp"
#include "host/base/table_writer.hpp"
#include "host/base/utc_text.hpp"
#include "host/can/loss_counter.hpp"
#include "host/can/open_bus.hpp"
#include "host/can/remedies.hpp"
#include "host/cli/bus_option.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/recording.hpp"
#include "host/system/stop_signal.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr const char* kRecordHelp =
    "Writes every frame on a bus into a log, as `candump -L` does (29-bit identifiers, remote and FD frames, "
    "too), until Ctrl-C or --duration.\n"
    "Beside it, in the same name with .toml: the config (-c), versions, and the fingers that were heard; it "
    "can be given to -c.\n"
    "If the program is killed, what was on the bus up to half a second before is in the file, in whole "
    "lines; if the disk is full, or the log is removed or cut meanwhile, it says so and ends with status "
    "1.\n"
    "--new-log-every: for weeks: goes on with another log, of which no frame is lost; each has its start "
    "(UTC) in its name, NAME-DATE-TIME.log.\n"
    "--json: an object log,notes,duration_s,frames,missed,gaps for each log, when it is complete.\n"
    "The log is what `decode`, `plot` and `replay` read.";

constexpr auto kFlushPeriod = 250ms;
constexpr double kShortestLog_s = 2;  ///< names differ by a second

struct RecordOptions {
  explicit RecordOptions(CLI::App& command) : common(command) {
    addBusOption(command, bus)->required();
    command.add_option("-o,--output", path, "The log to write; it must not be there yet")
        ->type_name("FILE")
        ->required();
    command.add_option("--duration", duration_s, "Seconds; until Ctrl-C without it")
        ->type_name("S")
        ->check(isFrom(0.001, 1e9));
    command
        .add_option("--new-log-every", newLogEvery_s, "Seconds after which another log begins (86400: a day)")
        ->type_name("S")
        ->check(isFrom(kShortestLog_s, 1e9));
  }
  CommonOptions common;
  std::string bus;
  std::string path;
  double duration_s = 0;  ///< 0: no end
  std::optional<double> newLogEvery_s;
};

void tellOfBus(can::BusPort& port, bool isThere) {
  const std::string now = utcText(now_ns());
  if (isThere) return tell("record: {}: {} is back\n", now, port.name());
  warn("record", fmt::format("{}: {} is away: {}; the recording goes on when it is back", now, port.name(),
                             port.hints().whenBlocked));
}

Clock::duration durationOf(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

/// "x.log"; of several "x-20261129-031200.log", by its start (UTC).
std::string nextPath(const RecordOptions& options) {
  if (!options.newLogEvery_s) return options.path;
  const std::filesystem::path path(options.path);
  const auto name = fmt::format("{}-{}{}", path.stem().string(), utcStamp(), path.extension().string());
  return (path.parent_path() / name).string();
}

/// Writes one log after the other.
class Recorder {
 public:
  Recorder(const RecordOptions& options, const config::FingerConfig& config, can::BusPort& port)
      : options_(options), config_(config), port_(port) {
    if (options.common.hasConfig()) tables_crc32_ = tables::buildTableImage(config).crc32;
    if (options.common.format() == TableFormat::kJson)
      table_.emplace(stdout, TableFormat::kJson,
                     std::vector<std::string>{"log", "notes", "duration_s", "frames", "missed", "gaps"});
    begin();
    port.hearOthers([this](const can::OtherFrame& other) { recording_->take(other); });
  }
  ~Recorder() { port_.hearOthers({}); }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  void recordUntil(Clock::time_point end, const system::StopSignal& stop) {
    for (Clock::time_point flushAt{}; !stop.asked() && Clock::now() < end;) {
      if (port_.waitReadable(system::StopSignal::kLookEvery))
        std::this_thread::sleep_for(can::BusPort::kGather);
      while (const auto frame = port_.receiveTimed()) take(*frame);
      if (recording_->lookAtBus()) tellOfBus(port_, recording_->isBusThere());
      if (Clock::now() < flushAt) continue;
      recording_->flush();
      warnOfFingers(*recording_);
      flushAt = Clock::now() + kFlushPeriod;
      if (options_.newLogEvery_s && Clock::now() - start_ >= durationOf(*options_.newLogEvery_s)) beginAnew();
    }
    finish(*recording_, start_);
  }

 private:
  void take(const can::TimedFrame& timed) {
    recording_->take(timed);
    losses_.count(port_.name(), timed.frame);
  }

  void begin() {
    recording_ = std::make_unique<Recording>(port_, config_, nextPath(options_));
    start_ = Clock::now();
  }

  /// The next log is begun before the last one is complete; if it can't be, the last one is completed all the
  /// same.
  void beginAnew() {
    const auto last = std::move(recording_);
    const auto lastStart = start_;
    std::exception_ptr why;
    try {
      begin();
    } catch (...) {
      why = std::current_exception();
    }
    try {
      finish(*last, lastStart);
    } catch (...) {
      if (!why) throw;
    }
    if (why) std::rethrow_exception(why);
    told_.clear();
  }

  void finish(Recording& recording, Clock::time_point start) {
    recording.end();
    const RecordingProgress& progress = recording.progress();
    const double duration_s = std::chrono::duration<double>(Clock::now() - start).count();
    tell("record: {} frames in {:.1f} s, {} missed: {}, {}\n", progress.frames, duration_s, progress.missed,
         recording.path(), recording.notesPath());
    if (const std::string name = recording.renamedTo(); !name.empty())
      warn("record", fmt::format("{} was renamed meanwhile: all is in {}", recording.path(), name));
    if (progress.gaps > 0)
      warn("record", fmt::format("{} was away {} meanwhile: {} says when", port_.name(),
                                 progress.gaps == 1 ? "once" : fmt::format("{} times", progress.gaps),
                                 recording.notesPath()));
    if (progress.frames == 0)
      warn("record",
           fmt::format("nothing was heard on {}: `strainfinger doctor --can {}` looks for the cause",
                       port_.name(), port_.name()));
    warnOfFingers(recording);
    if (table_)
      table_->row({recording.path(), recording.notesPath(), duration_s, std::int64_t(progress.frames),
                   std::int64_t(progress.missed), std::int64_t(progress.gaps)});
    std::fflush(stdout);
  }

  /// Once each, as soon as it is known: a recording may last for weeks.
  void warnOfFingers(const Recording& recording) {
    for (const can::NodeCount& count : losses_.counts()) {
      if (count.twoSenders)
        once(fmt::format("node {}: {}: {}", count.node, can::kTwinText,
                         can::forNode(can::kTwinRemedy, port_.name(), count.node)));
      else if (const std::string changes = can::tableChangesText(count); !changes.empty())
        once(fmt::format("node {}: {}", count.node, changes));
    }
    if (!tables_crc32_) return;
    // The notes beside the log quote the config, by which whoever reads it goes.
    if (const auto nodes = recording.nodesOfOtherTables(*tables_crc32_); !nodes.empty())
      once(fmt::format(
          "the tables of node {} are not those of {}, which the notes quote: read the log with that "
          "finger's own config (-c)",
          fmt::join(nodes, ", "), config_.source));
  }

  void once(const std::string& warning) {
    if (told_.insert(warning).second) warn("record", warning);
  }

  const RecordOptions& options_;
  const config::FingerConfig& config_;
  can::BusPort& port_;
  std::optional<std::uint32_t> tables_crc32_;  ///< of the config that was given
  std::optional<TableWriter> table_;
  can::LossCounter losses_;  ///< of all logs
  std::unique_ptr<Recording> recording_;
  Clock::time_point start_;     ///< of that one
  std::set<std::string> told_;  ///< warnings
};

void runRecord(const RecordOptions& options) {
  requireFolderOf("--output", options.path);
  const system::StopSignal stop;
  const config::FingerConfig config = options.common.config();
  const auto port = can::openBus(options.bus, config.can.bitrate);
  Recorder recorder(options, config, *port);
  recorder.recordUntil(
      options.duration_s > 0 ? Clock::now() + durationOf(options.duration_s) : Clock::time_point::max(),
      stop);
  if (stop.asked()) throw Failure(ExitCode::kInterrupted, "record: interrupted, all is written");
}

}  // namespace

void addRecord(CLI::App& app) { addCommand<RecordOptions>(app, "record", kRecordHelp, runRecord); }

}  // namespace strainfinger::cli
