#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include "common/frames.hpp"
#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/base/notice.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/can/log_reader.hpp"
#include "host/can/one_finger.hpp"
#include "host/can/open_bus.hpp"
#include "host/cli/bus_option.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/firmware_options.hpp"
#include "host/cli/recompute.hpp"
#include "host/cli/window_options.hpp"
#include "host/config/bus_load.hpp"
#include "host/system/stop_signal.hpp"

namespace strainfinger::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr const char* kReplayHelp =
    "Sends the frames of a log (any candump text with times) on a bus, each in its time.\n"
    "Nothing is sent if a line of it cannot be read. Frames that are not classic data frames with 11-bit "
    "identifiers are left out and counted; so are requests to fingers (0x600 + node), unless --requests: a "
    "finger that is on the bus obeys them, and takes a new zero or other tables. What a log has of several "
    "interfaces goes to the one bus, with a warning; --interface sends what it has of one.\n"
    "--recompute: sends nothing, but puts the RAW of a recording of -c's finger through the firmware's code, "
    "and compares the frames of touches, bit for bit. Exit status 6: they differ.";

constexpr auto kTryAgain = 1ms;
constexpr auto kGiveUp = 1s;

/// Of what is heard on the bus nothing is of use here. This identifier alone passes, which no finger sends.
constexpr can::BusFilter kHearNothing{.id = kMaxCanId, .mask = kMaxCanId};

struct ReplayOptions {
  explicit ReplayOptions(CLI::App& command) : common(command), firmware(command) {
    command.add_option("log", path, "The log")->type_name("FILE")->required();
    addBusOption(command, bus);
    addInterfaceOption(command, part.interface);
    addWindowOptions(command, part.window);
    command.add_flag("--recompute", recompute,
                     "Compute what the finger must have said from its RAW, and compare");
    command.add_flag("--requests", requests, "Send requests to fingers as well, which they obey");
    command.add_option("--speed", speed, "So many times as fast as it was (default 1)")
        ->check(isFrom(1e-3, 1e6));
  }
  CommonOptions common;
  FirmwareOptions firmware;
  std::string path;
  std::string bus;  ///< empty: none
  can::LogPart part;
  bool recompute = false;
  bool requests = false;
  std::optional<double> speed;
};

/// What there is to send.
struct LogExtent {
  std::uint64_t frames = 0;
  std::uint64_t requests = 0;
  std::uint64_t skipped = 0;
  std::set<std::string, std::less<>> interfaces;
};

bool isRequest(const CanFrame& frame) { return nodeOf(frame.id, FunctionCode::kRequest).has_value(); }

void requireFile(const std::string& path) {
  std::error_code notThere;
  const auto type = std::filesystem::status(path, notThere).type();
  if (path == "-" || type == std::filesystem::file_type::fifo ||
      type == std::filesystem::file_type::character)
    throw Failure(ExitCode::kUsage, "replay: the log must be a file, not a pipe: it is read twice");
}

/// Reads it all, so that nothing is sent of a log that cannot be read to its end.
LogExtent measure(const ReplayOptions& options) {
  requireFile(options.path);
  can::LogReader log(options.path, options.part);
  LogExtent extent;
  while (const auto text = log.next()) {
    ++(isRequest(text->frame) ? extent.requests : extent.frames);
    if (!extent.interfaces.contains(text->interface)) extent.interfaces.emplace(text->interface);
  }
  extent.skipped = log.skipped();
  warn("replay", log.warnings());
  log.requireAny();
  if (extent.interfaces.size() > 1)
    warn("replay",
         fmt::format("{}: what it has of several interfaces ({}) all goes to {}: --interface sends "
                     "what it has of one",
                     options.path, excerptNames({extent.interfaces.begin(), extent.interfaces.end()}),
                     options.bus));
  return extent;
}

/// False: asked to stop before.
bool sleepUntil(Clock::time_point time, const system::StopSignal& stop) {
  while (!stop.asked() && Clock::now() < time)
    std::this_thread::sleep_until(std::min(time, Clock::now() + system::StopSignal::kLookEvery));
  return !stop.asked();
}

void send(can::BusPort& port, const CanFrame& frame) {
  for (const auto giveUp = Clock::now() + kGiveUp; !port.send(frame);) {
    if (Clock::now() >= giveUp)
      throw Failure(ExitCode::kNoInterface, fmt::format("{}: it took no frame in a second: {}", port.name(),
                                                        port.hints().whenBlocked));
    std::this_thread::sleep_for(kTryAgain);
  }
}

/// A log whose clock was set meanwhile can ask for longer than a Clock tells.
Clock::duration waitFor(double since_s) {
  constexpr double kForEver_s = 1e9;
  return std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(std::clamp(since_s, -kForEver_s, kForEver_s)));
}

/// How many frames were sent.
std::uint64_t sendAll(const ReplayOptions& options, can::BusPort& port, const system::StopSignal& stop) {
  can::LogReader log(options.path, options.part);
  const auto start = Clock::now();
  std::optional<std::int64_t> first_ns;
  std::uint64_t sent = 0;
  while (const auto frame = log.next()) {
    if (!first_ns) first_ns = frame->time_ns;
    if (!options.requests && isRequest(frame->frame)) continue;
    const double since_s =
        static_cast<double>(*frame->time_ns - *first_ns) * 1e-9 / options.speed.value_or(1);
    if (!sleepUntil(start + waitFor(since_s), stop)) break;
    send(port, frame->frame);
    ++sent;
  }
  return sent;
}

void recomputeLog(const ReplayOptions& options) {
  const config::FingerConfig config = options.common.config();
  can::LogReader log(options.path, options.part);
  can::OneFinger one(config.can.node);
  const auto next = [&]() -> std::optional<can::TimedFrame> {
    const auto text = log.next();
    if (text) {
      one.watch(options.path, *text);
      return can::TimedFrame{*text->time_ns, text->frame};
    }
    log.requireAny();
    warn("replay", log.warnings());
    return std::nullopt;
  };
  const recompute::RecordedFinger finger{.node = static_cast<std::uint8_t>(config.can.node),
                                         .contactRate_hz = config::contactRate_hz(config.can),
                                         .mode = options.firmware.mode()};
  recompute(next, *options.firmware.tablesOf(config), finger, static_cast<std::uint32_t>(config.can.bitrate),
            options.common.format());
}

void runReplay(const ReplayOptions& options) {
  if (options.bus.empty() == !options.recompute)
    throw Failure(ExitCode::kUsage,
                  "replay: give either --can, to send the log, or --recompute, to check it");
  if (options.recompute && (options.speed || options.requests))
    throw Failure(ExitCode::kUsage,
                  "replay: --speed and --requests go with --can: --recompute sends nothing");
  if (options.recompute) return recomputeLog(options);
  const LogExtent extent = measure(options);
  const system::StopSignal stop;
  const auto port = can::openBus(options.bus, options.common.config().can.bitrate, kHearNothing);
  const std::uint64_t sent = sendAll(options, *port, stop);
  tell("replay: {} of {} frames sent, {} of other kinds left out\n", sent,
       extent.frames + (options.requests ? extent.requests : 0), extent.skipped);
  if (extent.requests > 0 && !options.requests)
    tell("replay: {} requests to fingers left out, too: --requests sends them\n", extent.requests);
  if (stop.asked()) throw Failure(ExitCode::kInterrupted, "replay: interrupted");
}

}  // namespace

void addReplay(CLI::App& app) { addCommand<ReplayOptions>(app, "replay", kReplayHelp, runReplay); }

}  // namespace strainfinger::cli
