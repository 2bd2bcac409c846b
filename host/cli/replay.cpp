#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include "host/base/failure.hpp"
#include "host/can/log_reader.hpp"
#include "host/can/open_bus.hpp"
#include "host/cli/bus_option.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/firmware_options.hpp"
#include "host/cli/recompute.hpp"
#include "host/system/stop_signal.hpp"

namespace strainfinger::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr const char* kReplayHelp =
    "Sends the frames of a log (any candump text with times) on a bus, each in its time.\n"
    "Nothing is sent if a line of it cannot be read. Frames that are not classic data frames with 11-bit "
    "identifiers are left out and counted; so are requests to fingers (0x600 + node), unless --requests: a "
    "finger that is on the bus obeys them, and takes a new zero or other tables.\n"
    "--recompute: sends nothing, but puts the RAW of a recording of -c's finger through the firmware's code, "
    "and compares "
    "the frames of touches, bit for bit. Exit status 6: they differ.";

constexpr auto kTryAgain = 1ms;
constexpr auto kGiveUp = 1s;

/// What comes back from the bus is nobody's: no identifier has all bits set but this one, which no finger
/// sends.
constexpr can::BusFilter kHearNothing{.id = kMaxCanId, .mask = kMaxCanId};

struct ReplayOptions {
  explicit ReplayOptions(CLI::App& command) : common(command), firmware(command) {
    command.add_option("log", path, "The log")->type_name("FILE")->required();
    addBusOption(command, bus);
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
  bool recompute = false;
  bool requests = false;
  std::optional<double> speed;
};

/// What there is to send.
struct LogExtent {
  std::uint64_t frames = 0;
  std::uint64_t requests = 0;
  std::uint64_t skipped = 0;
};

bool isRequest(const CanFrame& frame) { return nodeOf(frame.id, FunctionCode::kRequest).has_value(); }

/// Reads it all, so that nothing is sent of a log that cannot be read to its end.
LogExtent measure(const std::string& path) {
  std::error_code notThere;
  const auto type = std::filesystem::status(path, notThere).type();
  if (path == "-" || type == std::filesystem::file_type::fifo ||
      type == std::filesystem::file_type::character)
    throw Failure(ExitCode::kUsage, "replay: the log must be a file, not a pipe: it is read twice");
  can::LogReader log(path);
  LogExtent extent;
  while (const auto text = log.next()) ++(isRequest(text->frame) ? extent.requests : extent.frames);
  extent.skipped = log.skipped();
  warn("replay", log.warnings());
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

/// How many frames were sent.
std::uint64_t sendAll(const ReplayOptions& options, can::BusPort& port, const system::StopSignal& stop) {
  can::LogReader log(options.path);
  const auto start = Clock::now();
  std::optional<std::int64_t> first_ns;
  std::uint64_t sent = 0;
  while (const auto frame = log.next()) {
    if (!first_ns) first_ns = frame->time_ns;
    if (!options.requests && isRequest(frame->frame)) continue;
    const double since_s =
        static_cast<double>(*frame->time_ns - *first_ns) * 1e-9 / options.speed.value_or(1);
    const auto due = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(since_s));
    if (!sleepUntil(start + due, stop)) break;
    send(port, frame->frame);
    ++sent;
  }
  return sent;
}

void recomputeLog(const ReplayOptions& options) {
  can::LogReader log(options.path);
  const auto next = [&log]() -> std::optional<can::TimedFrame> {
    const auto text = log.next();
    if (text) return can::TimedFrame{*text->time_ns, text->frame};
    warn("replay", log.warnings());
    return std::nullopt;
  };
  const config::FingerConfig config = options.common.config();
  const recompute::RecordedFinger finger{
      .node = static_cast<std::uint8_t>(config.can.node),
      .contactRate_hz = static_cast<std::uint16_t>(std::lround(config.can.contact_rate_hz)),
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
  const LogExtent extent = measure(options.path);
  const system::StopSignal stop;
  const auto port = can::openBus(options.bus, options.common.config().can.bitrate, kHearNothing);
  const std::uint64_t sent = sendAll(options, *port, stop);
  fmt::print(stderr, "replay: {} of {} frames sent, {} of other kinds left out\n", sent,
             extent.frames + (options.requests ? extent.requests : 0), extent.skipped);
  if (extent.requests > 0 && !options.requests)
    fmt::print(stderr, "replay: {} requests to fingers left out, too: --requests sends them\n",
               extent.requests);
  if (stop.asked()) throw Failure(ExitCode::kInterrupted, "replay: interrupted");
}

}  // namespace

void addReplay(CLI::App& app) { addCommand<ReplayOptions>(app, "replay", kReplayHelp, runReplay); }

}  // namespace strainfinger::cli
