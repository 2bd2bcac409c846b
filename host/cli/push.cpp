#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/base/failure.hpp"
#include "host/base/notice.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/can/open_bus.hpp"
#include "host/can/other_tables.hpp"
#include "host/can/remedies.hpp"
#include "host/can/table_push.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/request.hpp"
#include "host/system/stop_signal.hpp"
#include "host/tables/self_check.hpp"
#include "host/tables/table_file.hpp"
#include "host/tables/table_text.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kPushHelp =
    "Sends a finger the tables that it is to work with: those of FILE (`tables -o`), or those of the config. "
    "Where there are several fingers, -n or -c says which is meant. It stops, takes them into its memory, "
    "starts anew and checks them.\n"
    "Do not touch it: a finger that feels a touch refuses, and one that starts takes its zero.\n"
    "A push that ends after its first word leaves the finger without tables (state fault): push again. One "
    "that ends before that changes nothing: the finger goes on with its old tables within 30 s. Its memory "
    "wears out: four at once, then one a minute, and none for a minute after a restart. While another "
    "program asks the finger, this one waits. With -c and FILE, FILE has to be of that config.\n"
    "Prints interface,node,table_crc,bytes. Exit status: 1 refused, or not done as it should be, 3 no "
    "interface, 4 no such node, 5 FILE is another finger's or of another format, 6 FILE is damaged or the "
    "finger refuses what it took.";

struct PushOptions {
  explicit PushOptions(CLI::App& command) : request(command) {
    command.add_option("FILE", path, "The tables; without it those of the config")->type_name("FILE");
    command.add_flag("--force", force,
                     "Even while something touches the finger, as one with wrong tables may feel");
  }
  RequestOptions request;
  std::string path;
  bool force = false;
};

/// A terminal that is closed, or a supervisor, sends more than one signal at once.
constexpr std::chrono::milliseconds kOneEvent{500};

/// In which each finger sends two HEARTBEATs.
constexpr std::chrono::milliseconds kListen{250};

using Fingers = std::map<std::uint8_t, HeartbeatFrame>;

/// Tables are one finger's: without -n and -c they would go to node 1, whosever they are.
void requireChosen(const RequestOptions& options, std::uint8_t node, const Fingers& heard) {
  if (options.node != 0 || options.common.hasConfig()) return;
  std::vector<int> nodes;
  for (const auto& [each, heartbeat] : heard) nodes.push_back(each);
  if (std::ranges::all_of(nodes, [&](int each) { return each == node; })) return;
  throw Failure(
      ExitCode::kUsage,
      fmt::format("push: {} has the fingers {}: say with -n, or with its config (-c), which of them "
                  "is to get these tables",
                  options.bus, fmt::join(nodes, ", ")));
}

/// The last byte of the CRC-32 of the tables with which the finger works, if they are others than these.
std::optional<std::uint8_t> othersOf(std::uint8_t node, const Fingers& heard, const TableImage& image) {
  const auto at = heard.find(node);
  if (at == heard.end() || at->second.state == FingerState::kFault) return std::nullopt;
  if (!can::hasOtherTables(at->second, image.crc32)) return std::nullopt;
  return at->second.table_crc;
}

/// The default finger's tables, which nobody named, take the place of no others.
void requireNamed(const PushOptions& options, std::uint8_t node, const Fingers& heard,
                  const TableImage& image) {
  const auto others = othersOf(node, heard, image);
  if (!others || !options.path.empty() || options.request.common.hasConfig()) return;
  throw Failure(
      ExitCode::kUsage,
      fmt::format("push: {} node {} has tables of its own (their CRC-32 ends with {:02X}), and these are "
                  "the default finger's ({:02X}): name those that it is to get: FILE, or its config (-c); "
                  "`strainfinger tables -o FILE` makes the default finger's",
                  options.request.bus, node, *others, tableCrcByte(image.crc32)));
}

/// What would bring it back is known only by what it was made from.
void tellReplaced(const can::BusPort& bus, std::uint8_t node, const Fingers& heard, const TableImage& image) {
  const auto others = othersOf(node, heard, image);
  if (!others) return;
  tell(
      "push: {} node {} has tables whose CRC-32 ends with {:02X}: their file, or the config they were made "
      "from, brings them back\n",
      bus.name(), node, *others);
}

std::unique_ptr<TableImage> tablesFor(const PushOptions& options) {
  const CommonOptions& common = options.request.common;
  if (options.path.empty()) {
    if (!common.hasConfig()) tell("push: neither FILE nor -c: the default finger's tables\n");
    return std::make_unique<TableImage>(tables::buildCheckedTables(common.config()).image);
  }
  auto image = tables::readTableFile(options.path);
  if (common.hasConfig()) tables::requireTablesOf(*image, common.config(), options.path);
  return image;
}

/// On a terminal only: how far it is.
class Progress {
 public:
  void show(int words) {
    const int percent = 100 * words / kTableWords;
    if (!isShown_ || percent == percent_) return;
    percent_ = percent;
    std::fputs(fmt::format("\rpush: {} %", percent).c_str(), stderr);
    std::fflush(stderr);
  }
  ~Progress() {
    if (percent_ >= 0) std::fputs("\r\x1b[K", stderr);
  }

 private:
  bool isShown_ = isatty(STDERR_FILENO) == 1;
  int percent_ = -1;
};

can::TablePush send(can::BusPort& port, std::uint8_t node, const TableImage& image, bool force,
                    const system::StopSignal& stop) {
  Progress progress;
  using Clock = std::chrono::steady_clock;
  std::optional<Clock::time_point> told;
  int heeded = 0;  // signals
  return can::pushTables(port, node, image, force, [&](int words) {
    progress.show(words);
    if (words == 0 || !stop.asked()) return !stop.asked();
    if (!told) {
      told = Clock::now();
      tell("{}push: goes on to the end, without which the finger has no tables; once more (Ctrl-C) ends it\n",
           isatty(STDERR_FILENO) == 1 ? "\r\x1b[K" : "");
    }
    if (Clock::now() - *told < kOneEvent) heeded = stop.times();
    return stop.times() == heeded;
  });
}

void requireWhole(const can::TablePush& push, const can::BusPort& bus, std::uint8_t node) {
  if (push.words == kTableWords) return;
  const std::string left = push.command == Command::kLoad
                               ? can::forNode(
                                     "the finger still has its old tables; where it has stopped, it goes on "
                                     "with them within half a minute, "
                                     "`strainfinger config --can BUS -n N --restart` at once",
                                     bus.name(), node)
                               : "the finger has no tables until they are pushed again";
  if (push.isStopped)
    throw Failure(ExitCode::kInterrupted,
                  fmt::format("push: interrupted after {} of {} words: {}", push.words, kTableWords, left));
  if (push.command == Command::kWord)
    tell("strainfinger: push: ended after {} of {} words: {}\n", push.words, kTableWords, left);
  if (push.othersAsk)
    tell("strainfinger: push: another program asks this finger, too: {}\n", can::kOthersAskRemedy);
  if (push.isOutOfStep)
    throw Failure(ExitCode::kFailure,
                  fmt::format("{} node {}: word {}: it answered that word {} is due, where word {} is: push "
                              "again; if this comes back, its firmware is not one that takes these tables",
                              bus.name(), node, push.words, push.reply.response->value, push.words + 1));
  requireDone(push.reply, push.command, bus, node);
}

/// With all words there.
void restart(can::BusPort& port, std::uint8_t node) {
  const can::Reply reply = can::ask(port, node, restartRequest(true));
  if (!reply.response || reply.response->status != CommandStatus::kDone)
    tell(
        "strainfinger: push: the finger has all words, and works with them from its next start on: "
        "`strainfinger config --can {} -n {} --restart`, or switch it off and on\n",
        port.name(), node);
  requireDone(reply, Command::kRestart, port, node);
}

void requireRunning(can::BusPort& port, std::uint8_t node, const TableImage& image,
                    const system::StopSignal& stop) {
  constexpr std::chrono::seconds kStartsWithin{3};
  const std::string where = fmt::format("{} node {}", port.name(), node);
  const auto heartbeat =
      can::heartbeatAfterRestart(port, node, kStartsWithin, [&stop] { return !stop.asked(); });
  if (stop.asked())
    throw Failure(ExitCode::kInterrupted,
                  fmt::format("push: interrupted: {} has all words and starts with them; `strainfinger "
                              "discover --can {}` shows whether it does",
                              where, port.name()));
  if (!heartbeat)
    throw Failure(ExitCode::kNoNode, fmt::format("{}: took the tables, but says nothing since it was told to "
                                                 "start anew: switch it off and on",
                                                 where));
  if (heartbeat->state == FingerState::kRun && can::isOlderThan(*heartbeat, kStartsWithin))
    throw Failure(
        ExitCode::kFailure,
        fmt::format("{}: took the tables, but did not start anew when it was told to: it is up for {} s; "
                    "switch it off and on",
                    where, heartbeat->uptime_s));
  const std::uint8_t wanted = tableCrcByte(image.crc32);
  if (heartbeat->state != FingerState::kFault && heartbeat->table_crc == wanted) return;
  throw Failure(
      ExitCode::kVerificationFailed,
      fmt::format(
          "{}: took the tables, but does not work with them: state {}, table_crc {:02X}, not "
          "{:02X}: they are for {} gauges: if its board reads fewer, push the tables of its own config (-c); "
          "else push them again; if it comes back, its memory is worn out, or its "
          "firmware takes tables of another format",
          where, can::nameText(kFingerStateNames, static_cast<int>(heartbeat->state)), heartbeat->table_crc,
          wanted, image.constants.gauge_count));
}

void runPush(const PushOptions& options) {
  const config::Can can = options.request.common.config().can;
  const std::uint8_t node = nodeOf(options.request.node, can);
  const auto image = tablesFor(options);
  const auto port = can::openBus(options.request.bus, can.bitrate);
  const system::StopSignal stop;
  const auto goOn = [&stop] { return !stop.asked(); };
  const Fingers heard = can::listenForFingers(*port, kListen, goOn);
  requireChosen(options.request, node, heard);
  requireNamed(options, node, heard, *image);
  requireOneFinger(*port, node, goOn);
  tellReplaced(*port, node, heard, *image);
  requireWhole(send(*port, node, *image, options.force, stop), *port, node);
  restart(*port, node);
  requireRunning(*port, node, *image, stop);
  if (options.force)
    tell(
        "push: what touches the finger now is part of its zero: `strainfinger tare --can {} -n {}` "
        "once nothing does\n",
        port->name(), node);
  TableWriter table(stdout, options.request.common.format(), {"interface", "node", "table_crc", "bytes"});
  table.row({options.request.bus, std::int64_t{node}, fmt::format("{:08X}", image->crc32),
             std::int64_t{sizeof *image}});
}

}  // namespace

void addPush(CLI::App& app) { addCommand<PushOptions>(app, "push", kPushHelp, runPush); }

}  // namespace strainfinger::cli
