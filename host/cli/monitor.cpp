#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "host/base/failure.hpp"
#include "host/base/line_reader.hpp"
#include "host/base/notice.hpp"
#include "host/base/utc_text.hpp"
#include "host/can/open_bus.hpp"
#include "host/cli/bus_option.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/recording.hpp"
#include "host/live/bus_watch.hpp"
#include "host/live/log_watch.hpp"
#include "host/live/plain_report.hpp"
#include "host/live/screen.hpp"
#include "host/live/terminal.hpp"
#include "host/system/stop_signal.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kMonitorHelp =
    "The fingers of a bus, live: where and how hard each is touched, with sigmas; flags and faults in words; "
    "contacts a second, jitter, lost frames, bus load.\n"
    "--can BUS: live. Without it, a log on stdin (any candump text): candump can0 | strainfinger monitor\n"
    "In a terminal a screen, drawn at most ten times a second. Keys: t zeroes the gauges of the finger that "
    "is marked (do not touch it), up and down mark another, r begins and ends a log in this folder, with "
    "notes as `record` writes them, q ends. NO_COLOR=1: no colours.\n"
    "Elsewhere, and with --plain, a line for each finger every second (--every), or with --json an object "
    "for each bus.\n"
    "Ctrl-C ends it too, with exit status 130.";

constexpr std::chrono::milliseconds kRedraw{100};

struct MonitorOptions {
  explicit MonitorOptions(CLI::App& command) : common(command) {
    addBusOption(command, bus);
    command.add_flag("--plain", plain, "Lines, even in a terminal");
    command.add_option("--every", every_s, "Seconds between lines")
        ->type_name("S")
        ->capture_default_str()
        ->check(isFrom(0.01, 86'400));
  }

  /// Of the tables that the fingers should have; nothing where no config says so.
  std::optional<std::uint32_t> tables_crc32() const {
    if (!common.hasConfig()) return std::nullopt;
    return tables::buildTableImage(common.config()).crc32;
  }
  bool wantsScreen() const { return !plain && common.format() == TableFormat::kCsv && live::hasTerminal(); }

  live::PlainReport plainReport() const {
    return {stdout, common.format(), every_s, live::terminalForm().unicode};
  }

  CommonOptions common;
  std::string bus;  ///< empty: a log on stdin
  bool plain = false;
  double every_s = 1;
};

void endIfStopped(const system::StopSignal& stop) {
  if (stop.asked()) throw Failure(ExitCode::kInterrupted, "monitor: interrupted");
}

/// A live bus on the terminal, until q is pressed.
class LiveScreen {
 public:
  LiveScreen(can::BusPort& port, const config::FingerConfig& config,
             std::optional<std::uint32_t> tables_crc32)
      : port_(port), config_(config), watch_(port, config, tables_crc32) {}

  void run() {
    const system::StopSignal stop;
    show(stop);
    if (recording_) {
      stopRecording();
      tell("monitor: {}\n", content_.message);
    }
    endIfStopped(stop);
  }

 private:
  void show(const system::StopSignal& stop) {
    live::Terminal terminal;
    while (!stop.asked() && !quit_) {
      watch_.listen(kRedraw);
      content_.buses = {watch_.view()};
      content_.selected = markedIndex();
      saveRecording();
      for (const live::Outcome& outcome : watch_.outcomes()) content_.message = outcome.text;
      while (const auto key = terminal.key()) press(*key);
      content_.keys = fmt::format("t tare  up/down mark  r {}  q quit",
                                  recording_ ? "stop recording " + recording_->path() : "record");
      terminal.show(live::drawScreen(content_, live::terminalForm()));
    }
  }

  void press(unsigned char key) {
    if (key == 'q') quit_ = true;
    if (key == live::kKeyDown) mark(content_.selected + 1);
    if (key == live::kKeyUp && content_.selected > 0) mark(content_.selected - 1);
    if (key == 'r') orSay([this] { recording_ ? stopRecording() : startRecording(); });
    if (key != 't') return;
    mark(content_.selected);
    if (marked_) tare(*marked_);
  }

  /// Fingers that come meanwhile stand between the others: the mark stays where a key has put it.
  std::size_t markedIndex() const {
    const auto& fingers = content_.buses.front().fingers;
    const auto found = std::ranges::find(fingers, marked_, &live::FingerView::node);
    return found == fingers.end() ? 0 : static_cast<std::size_t>(found - fingers.begin());
  }

  void mark(std::size_t index) {
    const auto& fingers = content_.buses.front().fingers;
    if (index >= fingers.size()) return;
    content_.selected = index;
    marked_ = fingers[index].node;
  }

  /// What goes wrong with a recording is said, and ends it: the fingers are still to be seen.
  template <typename Step>
  void orSay(Step step) {
    try {
      step();
    } catch (const Failure& failure) {
      dropRecording();
      content_.message = failure.what();
    }
  }

  void startRecording() {
    const std::string path = fmt::format("strainfinger-{}.log", utcStamp());
    recording_.emplace(port_, config_, path);
    watch_.setTap([this](const can::TimedFrame& timed) { recording_->take(timed); },
                  [this](const can::OtherFrame& other) { recording_->take(other); });
    content_.message.clear();
  }

  void stopRecording() {
    recording_->end();
    content_.message =
        fmt::format("{}: {} frames, {} missed; notes on it in {}", recording_->path(),
                    recording_->progress().frames, recording_->progress().missed, recording_->notesPath());
    dropRecording();
  }

  void dropRecording() {
    watch_.setTap({}, {});
    recording_.reset();
  }

  void saveRecording() {
    if (!recording_) return;
    recording_->lookAtBus();
    orSay([this] { recording_->flush(); });
  }

  void tare(std::uint8_t node) {
    content_.message = fmt::format("node {}: tare: do not touch it", node);
    watch_.request(node, tareRequest(false));
  }

  can::BusPort& port_;
  const config::FingerConfig& config_;
  live::BusWatch watch_;
  live::ScreenContent content_;
  std::optional<std::uint8_t> marked_;  ///< the node; nothing before a key was pressed: the first
  std::optional<Recording> recording_;
  bool quit_ = false;
};

void printLive(can::BusPort& port, const config::FingerConfig& config, const MonitorOptions& options) {
  const system::StopSignal stop;
  live::BusWatch watch(port, config, options.tables_crc32());
  live::PlainReport report = options.plainReport();
  while (!stop.asked()) {
    watch.listen(kRedraw);
    const live::BusView view = watch.view();
    if (report.due(view.time_us)) report.print({&view, 1});
  }
  endIfStopped(stop);
}

void monitorBus(const MonitorOptions& options) {
  const config::FingerConfig config = options.common.config();
  const auto port = can::openBus(options.bus, config.can.bitrate);
  if (options.wantsScreen()) return LiveScreen(*port, config, options.tables_crc32()).run();
  printLive(*port, config, options);
}

/// Waits for more, at most so long, and gives each line to take(line), the last one too if it lacks its end;
/// false at the end.
template <typename Take>
bool readLines(LineReader& reader, std::chrono::milliseconds longest, Take take) {
  const bool isOver = reader.read(longest) == LineReader::Got::kEnd;
  while (const auto line = reader.next()) take(*line);
  if (!isOver) return true;
  if (const auto last = reader.rest()) take(*last);
  return false;
}

/// A log on stdin.
class LogMonitor {
 public:
  explicit LogMonitor(const MonitorOptions& options)
      : watch_(options.common.config(), options.tables_crc32()),
        report_(options.plainReport()),
        screen_(options.wantsScreen()) {}

  void run() {
    const system::StopSignal stop;
    screen_ ? show(stop) : print(stop);
    if (watch_.time_us()) report_.print(watch_.views(*watch_.time_us()));
    endIfStopped(stop);
    if (unreadable_ > 0)
      throw Failure(ExitCode::kFailure, fmt::format("{} of {} lines could not be read; the first: {}",
                                                    unreadable_, lines_, firstError_));
  }

 private:
  void print(const system::StopSignal& stop) {
    const auto takeAndPrint = [this](std::string_view line) {
      take(line);
      const auto due_us = watch_.time_us() ? report_.due(*watch_.time_us()) : std::nullopt;
      if (due_us) report_.print(watch_.views(*due_us));
    };
    while (!stop.asked() && readLines(stdin_, kRedraw, takeAndPrint)) {}
  }

  void show(const system::StopSignal& stop) {
    using Clock = std::chrono::steady_clock;
    live::Terminal terminal;
    live::ScreenContent content;
    content.keys = "a log on stdin  q quit";
    Clock::time_point drawn, heard = Clock::now();
    for (bool more = true, quit = false; more && !quit && !stop.asked();) {
      const auto takeAndNote = [&](std::string_view line) {
        take(line);
        heard = Clock::now();
      };
      more = readLines(stdin_, kRedraw, takeAndNote);
      while (const auto key = terminal.key()) quit = quit || key == 'q';
      if (Clock::now() - drawn < kRedraw) continue;
      drawn = Clock::now();
      content.buses =
          watch_.views(watch_.time_us().value_or(0) +
                       std::chrono::duration_cast<std::chrono::microseconds>(drawn - heard).count());
      terminal.show(live::drawScreen(content, live::terminalForm()));
    }
  }

  void take(std::string_view line) {
    ++lines_;
    const auto error = watch_.take(line);
    if (!error) return;
    if (++unreadable_ == 1)
      firstError_ = fmt::format("stdin:{}:{}: {}", lines_, error->column, error->reason);
  }

  LineReader stdin_{"-"};
  live::LogWatch watch_;
  live::PlainReport report_;
  bool screen_;
  std::uint64_t lines_ = 0, unreadable_ = 0;
  std::string firstError_;
};

void runMonitor(const MonitorOptions& options) {
  if (options.bus.empty() && live::isKeyboard())
    throw Failure(ExitCode::kUsage,
                  "monitor: nothing to watch: give --can BUS, or a log: candump can0 | strainfinger monitor");
  options.bus.empty() ? LogMonitor(options).run() : monitorBus(options);
}

}  // namespace

void addMonitor(CLI::App& app) { addCommand<MonitorOptions>(app, "monitor", kMonitorHelp, runMonitor); }

}  // namespace strainfinger::cli
