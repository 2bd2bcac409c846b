#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include "common/frames.hpp"
#include "host/base/failure.hpp"
#include "host/can/candump_text.hpp"
#include "host/can/frame_printer.hpp"
#include "host/can/loss_counter.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kDecodeHelp =
    "What the frames in a candump text (stdin, any form) say.\n"
    "CSV: time_s,interface,node,frame, then a column for each field of any frame, empty where the frame has "
    "no such field or the value is not known; flags are names joined by '+'.\n"
    "--json: one object a frame with its own fields, null where not known.\n"
    "A line that cannot be read is reported as stdin:LINE:COLUMN on stderr and makes the exit status 1.\n"
    "At the end stderr says what was read, skipped and lost.\n"
    "Other devices can use the same identifiers (CANopen drives do): --node says which nodes are fingers.\n"
    "Live: candump vcan0 | strainfinger decode";

struct DecodeOptions {
  explicit DecodeOptions(CLI::App& command) : common(command) {
    command.add_option("-n,--node", nodes, "Only these nodes, as in 1,2,5")
        ->delimiter(',')
        ->check(CLI::Range(int{kFirstNode}, int{kLastNode}));
    command.add_flag("--strict", strict, "Stop at the first line that cannot be read");
  }
  CommonOptions common;
  std::vector<int> nodes;  ///< empty: all
  bool strict = false;
};

/// What became of the lines.
struct Tally {
  std::uint64_t lines = 0;
  std::uint64_t decoded = 0;
  std::uint64_t skipped = 0;  ///< frames that are none of a finger's
  std::uint64_t dropped = 0;  ///< by candump, as it says
  std::uint64_t unreadable = 0;
  std::string form;  ///< of the first line with a frame
  can::LossCounter losses;
};

class Decoder {
 public:
  explicit Decoder(const DecodeOptions& options)
      : printer_(stdout, options.common.format()), nodes_(options.nodes), strict_(options.strict) {}

  void decodeLine(const std::string& text) {
    ++tally_.lines;
    const auto parsed = can::parseLogLine(text);
    if (const auto* error = std::get_if<can::LogError>(&parsed))
      complain(*error);
    else
      take(std::get<can::LogLine>(parsed));
  }

  const Tally& tally() const { return tally_; }

 private:
  void complain(const can::LogError& error) {
    const std::string message = fmt::format("stdin:{}:{}: {}", tally_.lines, error.column, error.reason);
    if (strict_) throw Failure(ExitCode::kFailure, message);
    ++tally_.unreadable;
    fmt::print(stderr, "{}\n", message);
  }

  void take(const can::LogLine& line) {
    if (line.kind == can::LineKind::kNothing) return;
    tally_.dropped += line.dropped;
    if (line.kind == can::LineKind::kDropped) return;
    if (tally_.form.empty()) tally_.form = can::describeForm(line);
    const std::optional<CanFrame> frame = can::classicFrame(line);
    if (!frame || !isWanted(*frame) || !printer_.print(line.time_ns, line.interface, *frame)) {
      ++tally_.skipped;
      return;
    }
    ++tally_.decoded;
    tally_.losses.count(line.interface, *frame);
    flush();
  }

  /// The low seven bits of an identifier are the node, whatever the function.
  bool isWanted(const CanFrame& frame) const {
    return nodes_.empty() || std::find(nodes_.begin(), nodes_.end(), frame.id & 0x7F) != nodes_.end();
  }

  /// A row is out before the next line is waited for: candump may be live.
  static void flush() {
    if (std::fflush(stdout) != 0)
      throw Failure(ExitCode::kFailure, "cannot write the output: disk full or reader gone");
  }

  can::FramePrinter printer_;
  std::vector<int> nodes_;
  bool strict_;
  Tally tally_;
};

void summarise(const Tally& tally) {
  fmt::print(stderr, "decode: {} lines ({}), {} frames decoded, {} others skipped\n", tally.lines,
             tally.form.empty() ? "no frames" : tally.form, tally.decoded, tally.skipped);
  if (tally.dropped > 0) fmt::print(stderr, "decode: candump dropped {} frames\n", tally.dropped);
  for (const can::NodeCount& node : tally.losses.counts())
    fmt::print(stderr,
               "decode: {} node {}: {} frames of touches received, {} lost, {} repeated, {} restarts\n",
               node.interface, node.node, node.received, node.lost, node.repeated, node.restarts);
}

void checkProtocol(const Tally& tally) {
  for (const can::NodeCount& node : tally.losses.counts())
    if (node.protocol && *node.protocol != kProtocolVersion)
      throw Failure(
          ExitCode::kMismatch,
          fmt::format("{} node {} speaks protocol {}, this program {}: its frames mean something else; use "
                      "the strainfinger of its firmware",
                      node.interface, node.node, *node.protocol, kProtocolVersion));
}

void runDecode(const DecodeOptions& options) {
  Decoder decoder(options);
  std::cin.tie(nullptr);  // what is out is flushed above, and checked
  for (std::string line; std::getline(std::cin, line);) decoder.decodeLine(line);
  const Tally& tally = decoder.tally();
  summarise(tally);
  if (tally.unreadable > 0)
    throw Failure(ExitCode::kFailure, fmt::format("{} of {} lines could not be read; the others are decoded",
                                                  tally.unreadable, tally.lines));
  checkProtocol(tally);
}

}  // namespace

void addDecode(CLI::App& app) { addCommand<DecodeOptions>(app, "decode", kDecodeHelp, runDecode); }

}  // namespace strainfinger::cli
