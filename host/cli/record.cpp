#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "host/base/atomic_file.hpp"
#include "host/base/failure.hpp"
#include "host/can/log_writer.hpp"
#include "host/can/open_bus.hpp"
#include "host/cli/bus_option.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/recording_notes.hpp"
#include "host/system/stop_signal.hpp"

namespace strainfinger::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr const char* kRecordHelp =
    "Writes every frame on a bus into a log, as `candump -L` does, until Ctrl-C or --duration.\n"
    "Beside it, in the same name with .toml: the config (-c), versions, and the fingers that were heard; it "
    "can be "
    "given to -c.\n"
    "If the program is killed, what was on the bus up to half a second before is in the file, in whole "
    "lines; if the disk is "
    "full it says so and ends with status 1.\n"
    "The log is what `decode`, `plot` and `replay` read.";

/// Between a frame's arrival and reading: the frames that come meanwhile cost one awakening for all. Sockets
/// hold ten times what a full bus brings in it.
constexpr auto kGather = 5ms;

constexpr auto kFlushPeriod = 250ms;

struct RecordOptions {
  explicit RecordOptions(CLI::App& command) : common(command) {
    addBusOption(command, bus)->required();
    command.add_option("-o,--output", path, "The log to write; it must not be there yet")
        ->type_name("FILE")
        ->required();
    command.add_option("--duration", duration_s, "Seconds; until Ctrl-C without it")
        ->type_name("S")
        ->check(CLI::Range(0.001, 1e9));
  }
  CommonOptions common;
  std::string bus;
  std::string path;
  double duration_s = 0;  ///< 0: no end
};

std::int64_t now_ns() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

std::string notesPath(const std::string& path) {
  auto notes = std::filesystem::path(path).replace_extension(".toml").string();
  if (notes == path)
    throw Failure(ExitCode::kUsage, fmt::format("record: {}: a log cannot end in .toml: its notes do", path));
  return notes;
}

class Recorder {
 public:
  Recorder(const RecordOptions& options, const config::FingerConfig& config)
      : notesPath_(notesPath(options.path)),
        port_(can::openBus(options.bus, config.can.bitrate)),
        log_(options.path),
        notes_(options.bus, config) {
    progress_.start_ns = now_ns();
    writeNotes();
  }

  void runUntil(Clock::time_point end, const system::StopSignal& stop) {
    while (!stop.asked() && Clock::now() < end) {
      if (port_->waitReadable(system::StopSignal::kLookEvery)) std::this_thread::sleep_for(kGather);
      while (const auto frame = port_->receiveTimed()) take(*frame);
      if (Clock::now() >= flushAt_) flush();
    }
    flush();
    progress_.end_ns = now_ns();
    progress_.missed = port_->status().missed;
    writeNotes();
  }

  const RecordingProgress& progress() const { return progress_; }
  const std::string& notes() const { return notesPath_; }

 private:
  void take(const can::TimedFrame& timed) {
    log_.add(timed.time_ns, port_->name(), timed.frame);
    ++progress_.frames;
    isNew_ |= notes_.note(timed.frame);
  }

  void flush() {
    log_.flush();
    flushAt_ = Clock::now() + kFlushPeriod;
    if (std::exchange(isNew_, false)) writeNotes();
  }

  void writeNotes() const { writeFileAtomically(notesPath_, notes_.toml(progress_)); }

  std::string notesPath_;
  std::unique_ptr<can::BusPort> port_;
  can::LogWriter log_;
  RecordingNotes notes_;
  RecordingProgress progress_;
  bool isNew_ = false;  ///< the notes have to be written again
  Clock::time_point flushAt_{};
};

void runRecord(const RecordOptions& options) {
  const system::StopSignal stop;
  const auto start = Clock::now();
  Recorder recorder(options, options.common.config());
  const auto duration =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.duration_s));
  recorder.runUntil(options.duration_s > 0 ? start + duration : Clock::time_point::max(), stop);
  const RecordingProgress& progress = recorder.progress();
  fmt::print(stderr, "record: {} frames in {:.1f} s, {} missed: {}, {}\n", progress.frames,
             static_cast<double>(progress.end_ns - progress.start_ns) * 1e-9, progress.missed, options.path,
             recorder.notes());
  if (stop.asked()) throw Failure(ExitCode::kInterrupted, "record: interrupted, all is written");
}

}  // namespace

void addRecord(CLI::App& app) { addCommand<RecordOptions>(app, "record", kRecordHelp, runRecord); }

}  // namespace strainfinger::cli
