#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "common/frames.hpp"
#include "host/base/failure.hpp"
#include "host/base/line_reader.hpp"
#include "host/base/notice.hpp"
#include "host/base/text_output.hpp"
#include "host/can/candump_text.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/can/frame_printer.hpp"
#include "host/can/log_reader.hpp"
#include "host/can/log_times.hpp"
#include "host/can/per_node.hpp"
#include "host/can/remedies.hpp"
#include "host/can/time_window.hpp"
#include "host/can/touch_printer.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/decode_tally.hpp"
#include "host/cli/window_options.hpp"
#include "host/system/stop_signal.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kDecodeHelp =
    "What the frames in candump texts say: of files, or of stdin, in any form of candump.\n"
    "CSV: time_s,interface,node,frame, then a column for each field of any frame, empty where the frame has "
    "no such field or the value is not known; flags, faults and out_of_use are text: names, or numbers of "
    "gauges, joined by '+' ('5', '0+2'), empty where there are none.\n"
    "--json: one object a frame with its own fields, null where not known.\n"
    "The largest value of a field means this value or more (sigma_normal_n 0.127, sigma_width_m 0.065534 "
    "..).\n"
    "--touches: a row for each touch sample in place of its frames: where, how hard, how wide, how sure. "
    "Fields of lost frames are empty; without its CONTACT a sample has no row. The last row of a touch has "
    "no flag contact. time_s is the time of the CONTACT. A row is printed when it is complete, so rows of "
    "several fingers may be out of order by 0.2 s (more if HEARTBEATs are lost): sort them by time_s.\n"
    "Dates (candump -tA) are taken for those of this machine's time zone (TZ).\n"
    "A line that cannot be read is reported as FILE:LINE:COLUMN on stderr, of each file the first 20, and "
    "makes the exit status 1.\n"
    "At the end, or at Ctrl-C, stderr says what was read, skipped and lost.\n"
    "A finger whose HEARTBEAT says that it speaks another protocol has no rows from there on, and makes the "
    "exit status 5.\n"
    "Other devices can use the same identifiers (CANopen drives do): --node says which nodes are fingers.\n"
    "Live: candump vcan0 | strainfinger decode --touches\n"
    "or, from a bus between programs: strainfinger record --can udp -o x.log & strainfinger decode --follow "
    "x.log";

/// Lines of a file that are told of one by one where they cannot be read.
constexpr std::uint64_t kMostTold = 20;

/// How often a file that is followed is looked at.
constexpr std::chrono::milliseconds kFollowPeriod{50};

struct DecodeOptions {
  explicit DecodeOptions(CLI::App& command) : common(command) {
    command.add_option("files", paths, "candump texts, read in this order; stdin without any, or as -")
        ->type_name("FILE");
    addList(command, "-n,--node", nodes, "Only these nodes, as in 1,2,5", isNode())
        .type_name("N,N")
        ->allow_extra_args(false);  // what follows is a FILE
    addWindowOptions(command, window);
    command.add_flag("--touches", touches, "A row a touch sample, not a row a frame");
    command.add_flag("--follow", follow,
                     "Wait for FILE, and for what is yet to be written to it, until Ctrl-C; once its name is "
                     "another file's (rotation), go on with that, as tail -F does");
    command.add_flag("--strict", strict, "Stop at the first line that cannot be read");
  }
  CommonOptions common;
  std::vector<std::string> paths;
  std::vector<int> nodes;  ///< empty: all
  can::TimeWindow window;
  bool touches = false;
  bool follow = false;
  bool strict = false;
};

class Decoder {
 public:
  explicit Decoder(const DecodeOptions& options)
      : follow_(options.follow), strict_(options.strict), nodes_(options.nodes), asked_(options.window) {
    if (options.touches)
      touches_.emplace(output_.text(), options.common.format());
    else
      frames_.emplace(output_.text(), options.common.format());
  }

  /// Returns early when it is asked to stop.
  void decodeAll(const std::string& path) {
    if (follow_ && !waitFor(path)) return;
    lines_.emplace(path);
    do {
      window_ = asked_;
      decodeFile();
    } while (follow_ && openNext());
  }

  /// Prints what was held back for more of it.
  void finish() {
    if (touches_) touches_->finish();
    output_.flush();
  }

  /// Throws Failure(kFailure) where there were frames, and none of them was of the time that was asked for.
  void requireAnyInWindow() const {
    if (asked_.isWhole() || !first_ns_ || isAnyInWindow_) return;
    throw Failure(ExitCode::kFailure, fmt::format("decode: no frame is of that time: they are from {} to {}",
                                                  can::timeText(*first_ns_), can::timeText(last_ns_)));
  }

  /// What the losses are counted from are sequence numbers, one after the other.
  void judgeTimes() const {
    if (const std::string times = times_.warning(); !times.empty())
      warn("decode", fmt::format("{}; where files are given twice, or not in their order, losses are not "
                                 "counted right",
                                 times));
  }

  bool stopped() const { return stop_.asked(); }
  const DecodeTally& tally() const { return tally_; }

 private:
  /// Of a finger.
  struct Spoken {
    std::uint8_t protocol = kProtocolVersion;  ///< by its last HEARTBEAT
    CanFrame heartbeat;                        ///< that one
    bool isTold = false;                       ///< that the protocol is another
  };

  /// To its end or, followed, until its path names another file.
  void decodeFile() {
    unreadable_ = 0;
    bool isReplaced = false;
    while (!stopped()) {
      while (const auto text = lines_->next()) decodeLine(*text);
      output_.flush();  // before more is waited for: candump may be live
      if (lines_->read(system::StopSignal::kLookEvery) != LineReader::Got::kEnd) continue;
      if (!follow_ || isReplaced) break;
      isReplaced =
          lines_->isReplaced();  // and it is read once more: its end may have been written before that
      std::this_thread::sleep_for(kFollowPeriod);
    }
    const auto last = stopped() ? std::nullopt : lines_->rest();
    if (last) decodeLine(*last);
    output_.flush();
    if (unreadable_ > kMostTold)
      tell("{}: and {} more lines that cannot be read\n", lines_->name(), unreadable_ - kMostTold);
  }

  /// Until there is such a file, as `tail -F` does. False: it is asked to stop.
  bool waitFor(const std::string& path) const {
    std::error_code unknown;  // what cannot be looked at is named when it is opened
    const auto isMissing = [&] { return !std::filesystem::exists(path, unknown) && !unknown; };
    if (isMissing()) tell("decode: {} is not there yet: waiting for it\n", path);
    for (; isMissing(); std::this_thread::sleep_for(kFollowPeriod))
      if (stopped()) return false;
    return true;
  }

  /// False: it is asked to stop.
  bool openNext() {
    for (; !stopped(); std::this_thread::sleep_for(kFollowPeriod))
      if (lines_->reopen()) return true;
    return false;
  }

  void decodeLine(std::string_view text) {
    tally_.countLine();
    const auto plain = tally_.knowsForm() ? can::parsePlainLine(text) : std::nullopt;
    if (plain)
      take(*plain);
    else
      decodeAnyLine(text);
    output_.flushIfLarge();
  }

  void decodeAnyLine(std::string_view text) {
    const auto parsed = can::parseLogLine(text);
    if (const auto* error = std::get_if<can::LogError>(&parsed))
      complain(*error);
    else
      take(std::get<can::LogLine>(parsed));
  }

  void complain(const can::LogError& error) {
    const std::string message = fmt::format("{}:{}: {}", lines_->place(), error.column, error.reason);
    if (strict_) failAt(message);
    output_.flush();  // what stands before it
    tally_.countUnreadable();
    if (++unreadable_ <= kMostTold) tell("{}\n", message);
  }

  [[noreturn]] void failAt(const std::string& message) {
    finish();  // what stands before it
    throw Failure(ExitCode::kFailure, message);
  }

  void take(const can::LogLine& line) {
    tally_.countDropped(line.dropped);
    if (line.kind == can::LineKind::kNothing || line.kind == can::LineKind::kDropped) return;
    tally_.noteForm(line);
    const auto classic = can::classicFrame(line);
    if (classic) return take({line.time_ns, line.interface, *classic});
    if (line.time_ns && !isInWindow(*line.time_ns)) return tally_.countSkipped(SkipReason::kOtherTime);
    if (line.kind == can::LineKind::kError) return tally_.countSkipped(SkipReason::kError);
    if (line.kind == can::LineKind::kRemote) return tally_.countSkipped(SkipReason::kRemote);
    if (line.frame.fd) return tally_.countSkipped(SkipReason::kFd);
    tally_.countSkipped(SkipReason::kExtended);
  }

  void take(const can::TextFrame& text) {
    const CanFrame& frame = text.frame;
    if (text.time_ns) times_.watch(text.interface, *text.time_ns, *lines_);
    const can::FrameEntry* const entry = can::findFunction(frame.id);
    if (entry != nullptr) noteProtocol(text);
    if (!window_.isWhole() && !isInWindow(can::requireTime(text, *lines_)))
      return tally_.countSkipped(SkipReason::kOtherTime);
    if (entry == nullptr && can::findCommand(frame) == nullptr)
      return tally_.countSkipped(decode<RawFrame>(frame) ? SkipReason::kRaw : SkipReason::kOtherIdentifier);
    if (!isWanted(frame)) return tally_.countSkipped(SkipReason::kOtherNode);
    if (entry != nullptr && frame.length != entry->spec.length)
      return tally_.countWrongLength(lines_->place(), frame);
    if (speaksOther(text)) return tally_.countForeign(text.interface, frame);
    tally_.countDecoded(text.interface, frame);
    if (touches_)
      touches_->print(text.time_ns, text.interface, frame);
    else
      frames_->print(text.time_ns, text.interface, frame);
  }

  bool isWanted(const CanFrame& frame) const {
    return nodes_.empty() ||
           std::find(nodes_.begin(), nodes_.end(), can::fingerNode(frame.id)) != nodes_.end();
  }

  bool isInWindow(std::int64_t time_ns) {
    const bool isIn = window_.has(time_ns);
    isAnyInWindow_ |= isIn;
    first_ns_ = std::min(first_ns_.value_or(time_ns), time_ns);
    last_ns_ = std::max(last_ns_, time_ns);
    return isIn;
  }

  Spoken& spokenBy(const can::TextFrame& text) {
    return spoken_.at(text.interface, *can::fingerNode(text.frame.id));
  }

  void noteProtocol(const can::TextFrame& text) {
    const auto heartbeat = decode<HeartbeatFrame>(text.frame);
    if (!heartbeat) return;
    Spoken& spoken = spokenBy(text);
    spoken.protocol = heartbeat->protocol;
    spoken.heartbeat = text.frame;
  }

  /// Whether its finger does by its last HEARTBEAT, which this may be: its frames mean something else.
  bool speaksOther(const can::TextFrame& text) {
    Spoken& spoken = spokenBy(text);
    const bool isOther = spoken.protocol != kProtocolVersion;
    if (isOther && !std::exchange(spoken.isTold, true)) tellProtocol(text, spoken);
    return isOther;
  }

  void tellProtocol(const can::TextFrame& text, const Spoken& spoken) {
    if (!decode<HeartbeatFrame>(text.frame)) tally_.noteForeign(text.interface, spoken.heartbeat);
    output_.flush();  // what stands before it
    warn("decode",
         fmt::format("{}: {} node {} {}; what it says from here on is left out", lines_->place(),
                     text.interface, *can::fingerNode(text.frame.id), can::foreignText(spoken.protocol)));
  }

  system::StopSignal stop_;
  TextOutput output_{stdout};
  std::optional<can::FramePrinter> frames_;   ///< or
  std::optional<can::TouchPrinter> touches_;  ///< one of these
  bool follow_;
  bool strict_;
  std::vector<int> nodes_;
  can::TimeWindow asked_;
  can::TimeWindow window_;  ///< asked_, of the file that is read
  bool isAnyInWindow_ = false;
  std::optional<std::int64_t> first_ns_;  ///< of all frames, if only a part is asked for
  std::int64_t last_ns_ = 0;
  can::PerNode<Spoken> spoken_;
  std::optional<LineReader> lines_;  ///< of the file that is read
  std::uint64_t unreadable_ = 0;     ///< lines of it
  can::LogTimes times_{can::LogTimes::Order::kOfEachInterface};
  DecodeTally tally_;
};

void requireGoodPaths(const DecodeOptions& options) {
  if (options.follow && (options.paths.size() != 1 || options.paths.front() == "-"))
    throw Failure(ExitCode::kUsage, "decode: --follow needs one FILE: stdin is followed to its end anyway");
  if (options.follow) return requireFolderOf("--follow", options.paths.front());
  for (const std::string& path : options.paths)
    LineReader::requireReadable(path);  // nothing is printed if one is not there
}

void runDecode(const DecodeOptions& options) {
  options.common.requireGoodConfig();
  requireGoodPaths(options);
  Decoder decoder(options);
  const auto paths = options.paths.empty() ? std::vector<std::string>{"-"} : options.paths;
  for (const std::string& path : paths)
    if (!decoder.stopped()) decoder.decodeAll(path);
  decoder.finish();
  decoder.tally().summarise();
  decoder.judgeTimes();
  decoder.tally().requireGood();
  if (!decoder.stopped()) decoder.requireAnyInWindow();
  if (decoder.stopped()) throw Failure(ExitCode::kInterrupted, "decode: interrupted");
}

}  // namespace

void addDecode(CLI::App& app) { addCommand<DecodeOptions>(app, "decode", kDecodeHelp, runDecode); }

}  // namespace strainfinger::cli
