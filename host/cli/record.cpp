#include <fmt/format.h>

#include <chrono>
#include <string>
#include <thread>

#include "host/base/failure.hpp"
#include "host/base/notice.hpp"
#include "host/base/utc_text.hpp"
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
    "The log is what `decode`, `plot` and `replay` read.";

constexpr auto kFlushPeriod = 250ms;

struct RecordOptions {
  explicit RecordOptions(CLI::App& command) : common(command) {
    addBusOption(command, bus)->required();
    command.add_option("-o,--output", path, "The log to write; it must not be there yet")
        ->type_name("FILE")
        ->required();
    command.add_option("--duration", duration_s, "Seconds; until Ctrl-C without it")
        ->type_name("S")
        ->check(isFrom(0.001, 1e9));
  }
  CommonOptions common;
  std::string bus;
  std::string path;
  double duration_s = 0;  ///< 0: no end
};

void tellOfBus(can::BusPort& port, bool isThere) {
  const std::string now = utcText(now_ns());
  if (isThere) return tell("record: {}: {} is back\n", now, port.name());
  warn("record", fmt::format("{}: {} is away: {}; the recording goes on when it is back", now, port.name(),
                             port.hints().whenBlocked));
}

void recordUntil(Clock::time_point end, const system::StopSignal& stop, can::BusPort& port,
                 Recording& recording) {
  for (Clock::time_point flushAt{}; !stop.asked() && Clock::now() < end;) {
    if (port.waitReadable(system::StopSignal::kLookEvery)) std::this_thread::sleep_for(can::BusPort::kGather);
    while (const auto frame = port.receiveTimed()) recording.take(*frame);
    if (recording.lookAtBus()) tellOfBus(port, recording.isBusThere());
    if (Clock::now() < flushAt) continue;
    recording.flush();
    flushAt = Clock::now() + kFlushPeriod;
  }
  recording.end();
}

/// The notes beside the log quote the config, by which whoever reads it goes.
void warnOfOtherTables(const Recording& recording, const config::FingerConfig& config) {
  const auto nodes = recording.nodesOfOtherTables(tables::buildTableImage(config).crc32);
  if (nodes.empty()) return;
  warn("record", fmt::format("the tables of node {} are not those of {}, which the notes quote: read the log "
                             "with that finger's own config (-c)",
                             fmt::join(nodes, ", "), config.source));
}

void runRecord(const RecordOptions& options) {
  requireFolderOf("--output", options.path);
  const system::StopSignal stop;
  const config::FingerConfig config = options.common.config();
  const auto port = can::openBus(options.bus, config.can.bitrate);
  Recording recording(*port, config, options.path);
  port->hearOthers([&](const can::OtherFrame& other) { recording.take(other); });
  const auto start = Clock::now();
  const auto duration =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.duration_s));
  recordUntil(options.duration_s > 0 ? start + duration : Clock::time_point::max(), stop, *port, recording);
  const RecordingProgress& progress = recording.progress();
  tell("record: {} frames in {:.1f} s, {} missed: {}, {}\n", progress.frames,
       std::chrono::duration<double>(Clock::now() - start).count(), progress.missed, recording.path(),
       recording.notesPath());
  if (const std::string name = recording.renamedTo(); !name.empty())
    warn("record", fmt::format("{} was renamed meanwhile: all is in {}", recording.path(), name));
  if (progress.gaps > 0)
    warn("record", fmt::format("{} was away {} meanwhile: {} says when", port->name(),
                               progress.gaps == 1 ? "once" : fmt::format("{} times", progress.gaps),
                               recording.notesPath()));
  if (progress.frames == 0)
    warn("record", fmt::format("nothing was heard on {}: `strainfinger doctor --can {}` looks for the cause",
                               port->name(), port->name()));
  for (const std::uint8_t node : recording.nodesOfTwins())
    warn("record", fmt::format("node {}: {}: {}", node, can::kTwinText,
                               can::forNode(can::kTwinRemedy, port->name(), node)));
  if (options.common.hasConfig()) warnOfOtherTables(recording, config);
  if (stop.asked()) throw Failure(ExitCode::kInterrupted, "record: interrupted, all is written");
}

}  // namespace

void addRecord(CLI::App& app) { addCommand<RecordOptions>(app, "record", kRecordHelp, runRecord); }

}  // namespace strainfinger::cli
