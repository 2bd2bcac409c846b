#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/frames.hpp"
#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/can/log_reader.hpp"
#include "host/can/loss_counter.hpp"
#include "host/can/remedies.hpp"
#include "host/can/touch_receiver.hpp"
#include "host/cli/bus_option.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/window_options.hpp"
#include "host/plot/log_picture.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kPlotHelp =
    "Draws what a finger said in a log (any candump text with times): angle, forces and width with bands of "
    "one sigma, and the flags, over time. Needs gnuplot.\n"
    "Beside the picture stay its data (CSV) and the script that draws it.\n"
    "Of a long log some of the touches are drawn, evenly over its time.";

/// More make a larger file, not another picture.
constexpr std::size_t kMostPoints = 4000;

struct PlotOptions {
  explicit PlotOptions(CLI::App& command) : common(command) {
    command.add_option("log", path, "The log; - is stdin")->type_name("FILE")->required();
    command.add_option("-o,--output", output, "The picture; ends in .svg or .png")
        ->type_name("FILE")
        ->required();
    command.add_option("-n,--node", node, "Of this node, where the log has several")->check(isNode());
    addInterfaceOption(command, part.interface);
    addWindowOptions(command, part.window);
  }
  CommonOptions common;
  std::string path;
  std::string output;
  std::optional<int> node;
  can::LogPart part;
};

/// What one finger said. Keeps every touch up to twice kMostPoints, then every second of them, and so on.
class Track {
 public:
  explicit Track(std::uint8_t node) : receiver_(node) {}

  void take(double time_s, const CanFrame& frame) {
    const auto touch = receiver_.take(frame);
    if (!touch || count_++ % stride_ != 0) return;
    points_.push_back({time_s, *touch});
    if (points_.size() >= 2 * kMostPoints) halve();
  }

  const std::vector<plot::LogPoint>& points() const { return points_; }

 private:
  void halve() {
    for (std::size_t i = 0; 2 * i < points_.size(); ++i) points_[i] = points_[2 * i];
    points_.resize((points_.size() + 1) / 2);
    stride_ *= 2;
  }

  can::TouchReceiver receiver_;
  std::uint64_t count_ = 0;
  std::uint64_t stride_ = 1;
  std::vector<plot::LogPoint> points_;
};

/// Interface and node.
using Name = std::pair<std::string, int>;

struct Heard {
  std::map<Name, Track> tracks;  ///< that have touches
  can::LossCounter losses;
};

Heard readLog(const PlotOptions& options) {
  can::LogReader log(options.path, options.part);
  Heard heard;
  while (const auto text = log.next()) {
    const can::FrameEntry* const entry = can::findFrame(text->frame);
    if (entry == nullptr) continue;
    const std::uint8_t node = *nodeOf(text->frame.id, entry->spec.function);
    if (options.node && node != *options.node) continue;
    heard.losses.count(text->interface, text->frame);
    Track& track = heard.tracks.try_emplace({std::string(text->interface), node}, node).first->second;
    track.take(static_cast<double>(*text->time_ns - *log.first_ns()) * 1e-9, text->frame);
  }
  warn("plot", log.warnings());
  std::erase_if(heard.tracks, [](const auto& track) { return track.second.points().empty(); });
  return heard;
}

/// The options that tell these fingers apart.
std::string choiceOf(const std::map<Name, Track>& tracks) {
  std::set<std::string> interfaces;
  std::set<int> nodes;
  for (const auto& [name, track] : tracks) {
    interfaces.insert(name.first);
    nodes.insert(name.second);
  }
  if (nodes.size() == tracks.size()) return "--node";
  return interfaces.size() == tracks.size() ? "--interface" : "--interface and --node";
}

void requireNotSeveral(const PlotOptions& options, const std::map<Name, Track>& tracks) {
  if (tracks.size() < 2) return;
  std::vector<std::string> names;
  for (const auto& [name, track] : tracks)
    names.push_back(fmt::format("{} node {}", name.first, name.second));
  throw Failure(ExitCode::kUsage, fmt::format("{}: several fingers ({}): choose one with {}", options.path,
                                              excerptNames(names), choiceOf(tracks)));
}

/// Whether what is drawn is what a finger meant; without anything to draw, whether that is why.
void judge(const PlotOptions& options, const Heard& heard) {
  for (const can::NodeCount& count : heard.losses.counts()) {
    if (!heard.tracks.empty() && !heard.tracks.contains({count.interface, count.node})) continue;
    can::requireOurProtocol(count);
    if (const std::string changes = can::tableChangesText(count); !changes.empty() && !count.twoSenders)
      warn("plot", fmt::format("{}: {} node {}: {}", options.path, count.interface, count.node, changes));
    if (count.twoSenders)
      warn("plot", fmt::format("{}: {} node {}: {}, and the picture mixes what they say: {}", options.path,
                               count.interface, count.node, can::kTwinText,
                               can::forNode(can::kTwinRemedy, count.interface, count.node)));
  }
}

void requireAny(const PlotOptions& options, const std::map<Name, Track>& tracks) {
  if (!tracks.empty()) return;
  const std::string& interface = options.part.interface;
  std::string whose = interface.empty() ? "" : fmt::format(" of {}", excerpt(interface));
  if (options.node) whose += fmt::format(" of node {}", *options.node);
  if (!options.part.window.isWhole()) whose += " from --from to --to";
  throw Failure(ExitCode::kFailure, fmt::format("{}: no touch{} in it to draw", options.path, whose));
}

void runPlot(const PlotOptions& options) {
  options.common.requireGoodConfig();
  options.common.requireNoneNamed("--output", plot::filesBeside(options.output, plot::kLogData));
  plot::requirePicturePath(options.output);
  requireFolderOf("--output", options.output);
  const Heard heard = readLog(options);
  requireNotSeveral(options, heard.tracks);
  judge(options, heard);
  requireAny(options, heard.tracks);
  const auto& [name, track] = *heard.tracks.begin();
  plot::draw(plot::logPicture(
                 {.heading = fmt::format("{}, node {}", name.first, name.second), .points = track.points()}),
             options.output);
}

}  // namespace

void addPlot(CLI::App& app) { addCommand<PlotOptions>(app, "plot", kPlotHelp, runPlot); }

}  // namespace strainfinger::cli
