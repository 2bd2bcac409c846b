#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "host/base/atomic_file.hpp"
#include "host/base/failure.hpp"
#include "host/base/notice.hpp"
#include "host/base/text_output.hpp"
#include "host/can/candump_text.hpp"
#include "host/can/loopback_port.hpp"
#include "host/can/open_bus.hpp"
#include "host/cli/bus_option.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/firmware_options.hpp"
#include "host/cli/run_summary.hpp"
#include "host/cli/strain_recorder.hpp"
#include "host/cli/touch_recorder.hpp"
#include "host/cli/truth_table.hpp"
#include "host/simulation/gauge_fault.hpp"
#include "host/simulation/read_scenario.hpp"
#include "host/simulation/simulated_finger.hpp"
#include "host/system/metronome.hpp"
#include "host/system/stop_signal.hpp"
#include "host/tables/gauge_gains.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kLoopback = "loopback";
constexpr int kUsualRows_hz = 100;

constexpr const char* kRunHelp =
    "The finger itself on this machine: the firmware's own code, simulated gauges, frames on CAN.\n"
    "--can loopback (default): a bus that no other program hears, as fast as it can; prints what `candump "
    "-L` would, and the same seed gives the same output.\n"
    "--can BUS: for other programs, in real time, a sample set every millisecond; prints nothing on stdout. "
    "It obeys `tare`, `config` and `push`, and like a board takes no other tables in the minute after a "
    "restart; tables that it is sent are lost when it ends, and it refuses to keep settings.\n"
    "The simulated finger is as the config's [as_built] says or, without it, as drawn and calibrated.\n"
    "At the end stderr has a summary with the errors against the truth. Ctrl-C ends a run as its duration "
    "would, with exit status 130.\n"
    "--json: the summary as one object of duration_s,sample_sets,overruns,fits,frames,touches,heartbeats,"
    "touches_busy,touches_incomplete,compared,arc_rms_m,arc_worst_m,normal_rms_n_per_m,normal_worst_n_per_m,"
    "tangential_rms_n_per_m,tangential_worst_n_per_m,uncertain,other_number,phantom,missed,untold_s,"
    "gauges_out_of_use.\n"
    "  overruns           sample sets lost because this machine was late; `info` calls them lost_sets\n"
    "  touches_busy       put off because the bus was busy\n"
    "  touches_incomplete not sent whole\n"
    "  compared           answers that were compared with the truth; arc_.. to tangential_.. are their "
    "errors\n"
    "  uncertain          answers that were not, as they were flagged\n"
    "  other_number       the same, as they had another number of contacts than there were\n"
    "  phantom, missed    a contact where nothing touched; none where something did\n"
    "  untold_s           seconds in which something touched and no contact was reported";

struct RunOptions {
  explicit RunOptions(CLI::App& command) : common(command), firmware(command) {
    addBusOption(command, bus);
    command
        .add_option("--scenario", scenarioPath,
                    "What touches the finger (TOML, as the head of "
                    "host/simulation/scenarios/touches.toml describes it); that one, which is built in, "
                    "without it")
        ->type_name("FILE");
    command
        .add_option("--seed", seed, fmt::format("Of the noise and of the gauges' zeros (default {})", seed))
        ->check(isSeed());
    command.add_option("-n,--node", node, "Node number in place of the config's")->check(isNode());
    command
        .add_option("--duration", duration_s,
                    "Seconds; without it the loopback runs the scenario once, a bus until Ctrl-C")
        ->type_name("S")
        ->check(isFrom(0.001, 1e6));
    command
        .add_option(
            "--fault", faults,
            fmt::format("A gauge fails, at a second or from the start, as in stuck:5@2.5: KIND is one of {}; "
                        "may be given several times",
                        simulation::gaugeFaultKinds()))
        ->type_name("KIND:GAUGE[@S]");
    command.add_flag("--uncalibrated", uncalibrated,
                     "The tables don't know the config's [calibration]; gauges.model_error is 0.05 at least");
    command.add_flag("--truth", truth, "Truth beside estimate on stderr, four lines a second");
    command
        .add_option("--strains", strainsPath,
                    "At the end, what the gauges read, as `calibrate`, `shape` and `locate` take it (CSV)")
        ->type_name("FILE");
    command
        .add_option(
            "--touches", touchesPath,
            "At the end, what touched the finger, a row for each row of --strains (CSV): "
            "angle_deg,normal_n_per_m,tangential_n_per_m, loads of 0 where nothing does; its cells are "
            "empty while several touches do, which a row cannot say")
        ->type_name("FILE");
    command
        .add_option("--rows-hz", rows_hz,
                    fmt::format("Rows of --strains and --touches a second (default {})", kUsualRows_hz))
        ->type_name("HZ")
        ->check(isWhole(1, 1000));
    command
        .add_option("--picture", pictures,
                    "Draws the run (needs gnuplot); ends in .svg or .png, may be given twice")
        ->type_name("FILE");
  }
  bool isLoopback() const { return bus == kLoopback; }
  config::FingerConfig config() const {
    config::FingerConfig config = common.config();
    if (node != 0) config.can.node = node;
    return config;
  }

  CommonOptions common;
  FirmwareOptions firmware;
  std::string bus = kLoopback;
  std::string scenarioPath;
  std::uint64_t seed = 1;
  int node = 0;  ///< 0: the config's
  std::optional<double> duration_s;
  bool uncalibrated = false;
  bool truth = false;
  std::string strainsPath;
  std::string touchesPath;
  std::optional<int> rows_hz;
  std::vector<std::string> pictures;
  std::vector<std::string> faults;
};

simulation::Scenario scenarioOf(const RunOptions& options, const config::Finger& finger) {
  if (options.scenarioPath.empty()) return simulation::builtInScenario();
  const simulation::Scenario scenario = simulation::readScenarioFile(options.scenarioPath);
  simulation::requireUntouchedStart(scenario, options.scenarioPath);
  const double round_m = 2 * std::numbers::pi * finger.outer_radius_m;
  if (scenario.widest_m() > round_m)
    throw Failure(ExitCode::kUsage,
                  fmt::format("{}: touch.width_m = {} goes more than once round the finger, {:.3g} m",
                              options.scenarioPath, scenario.widest_m(), round_m));
  return scenario;
}

/// Of a run that ends then.
std::vector<simulation::GaugeFault> faultsOf(const RunOptions& options, double end_s) {
  std::vector<simulation::GaugeFault> faults;
  for (const std::string& text : options.faults) {
    faults.push_back(simulation::readGaugeFault(text));
    if (faults.back().start_s >= end_s)
      throw Failure(ExitCode::kUsage, fmt::format("--fault {}: the run ends before, at {} s", text, end_s));
  }
  return faults;
}

/// The finger may flag such a touch, and a user would look for the fault elsewhere.
void warnOfSlip(const RunOptions& options, const simulation::Scenario& scenario,
                double friction_coefficient) {
  const auto slip = scenario.firstSlip(friction_coefficient);
  if (!slip) return;
  warn("run", fmt::format(
                  "{}: touch {} slips even where it presses most: {} N/m along are more than friction holds, "
                  "{} (contact.friction_coefficient) of {} N/m of load; it may be flagged uncertain",
                  options.scenarioPath.empty() ? "the built-in scenario" : options.scenarioPath, slip->number,
                  slip->touch.tangential_n_per_m, friction_coefficient, slip->touch.normal_n_per_m));
}

constexpr double kForEver_s = 1e12;

double durationOf(const RunOptions& options, const simulation::Scenario& scenario) {
  if (options.duration_s) return *options.duration_s;
  if (!options.isLoopback()) return kForEver_s;
  if (scenario.duration_s() > 0) return scenario.duration_s();
  throw Failure(ExitCode::kUsage, "run: the scenario has no touch and so no end: give --duration S");
}

/// What watches a run: the table, the picture, the statistics.
class Watchers {
 public:
  /// `known`: what the tables know of the finger.
  Watchers(const RunOptions& options, const config::FingerConfig& known, const TableImage& tables)
      : finger_(known.finger), strainsPath_(options.strainsPath), touchesPath_(options.touchesPath) {
    const auto factors = tables::correctionFactors(tables.gains, known.gauges.count);
    if (!strainsPath_.empty() || !touchesPath_.empty())
      strains_.emplace(factors, options.rows_hz.value_or(kUsualRows_hz));
    if (options.truth) table_.emplace(stderr, finger_);
    if (!options.pictures.empty()) recorder_.emplace(known, factors);
  }

  void watch(const simulation::Moment& moment, const firmware::Readings& readings) {
    if (table_) table_->add(moment);
    if (recorder_) recorder_->add(moment, readings);
    if (strains_ && !moment.isZeroing) strains_->add(moment, readings.strain_q32);
    errors_.add(moment, finger_);
  }

  void write() const {
    if (!strainsPath_.empty()) writeFileAtomically(strainsPath_, strains_->strains());
    if (!touchesPath_.empty()) writeFileAtomically(touchesPath_, strains_->touches());
  }

  void draw(const std::vector<std::string>& paths, const simulation::GaugeStrains& strains) const {
    for (const std::string& path : paths) plot::draw(plot::touchPicture(recorder_->record(strains)), path);
  }

  const simulation::TouchErrors& errors() const { return errors_; }

 private:
  config::Finger finger_;
  std::optional<TruthTable> table_;
  std::optional<TouchRecorder> recorder_;
  std::optional<StrainRecorder> strains_;
  std::string strainsPath_;
  std::string touchesPath_;
  simulation::TouchErrors errors_;
};

/// What the tables know of the finger.
config::FingerConfig knownOf(config::FingerConfig config, const RunOptions& options) {
  if (!options.uncalibrated) return config;
  config.calibration = {};
  config.gauges.model_error = std::max(config.gauges.model_error, config::Gauges{}.model_error);
  return config;
}

void requireOutputs(const RunOptions& options) {
  for (const std::string& path : options.pictures) {
    plot::requirePicturePath(path);
    requireFolderOf("--picture", path);
  }
  requireFolderOf("--strains", options.strainsPath);
  requireFolderOf("--touches", options.touchesPath);
}

/// Runs a finger on `port` to its end. wait() lets a sample period pass and says how many really did;
/// afterwards(time_us) comes after the work of each.
template <typename Port, typename Wait, typename Afterwards>
void runOn(Port& port, const config::FingerConfig& config, const RunOptions& options, Wait wait,
           Afterwards afterwards) {
  const config::FingerConfig known = knownOf(config, options);
  const auto tables = options.firmware.tablesOf(known);
  options.firmware.warnOfMode("run", *tables);
  const simulation::Scenario scenario = scenarioOf(options, config.finger);
  const double end_s = durationOf(options, scenario);
  const auto end_us = static_cast<std::uint64_t>(std::llround(end_s * 1e6));
  simulation::SimulatedFinger finger(config, scenario, *tables, options.firmware.mode(), options.seed, port,
                                     faultsOf(options, end_s));
  Watchers watchers(options, known, *tables);
  requireOutputs(options);
  warnOfSlip(options, scenario, config.contact.friction_coefficient);
  const system::StopSignal stop;
  while (finger.elapsed_us() < end_us && !stop.asked()) {
    finger.pass(wait(), [&](const simulation::Moment& moment) { watchers.watch(moment, finger.readings()); });
    afterwards(finger.elapsed_us());
  }
  tell(summaryText(options.common.format(), finger.elapsed_s(), finger.counts(), watchers.errors()));
  watchers.write();
  watchers.draw(options.pictures, finger.strains());
  if (stop.asked())
    throw Failure(ExitCode::kInterrupted, fmt::format("run: interrupted after {:.3f} s", finger.elapsed_s()));
}

/// The other node of the loopback bus: prints what it hears.
class Candump {
 public:
  explicit Candump(can::LoopbackBus& bus) : port_(bus) {}

  void print(std::uint64_t time_us) {
    while (const auto frame = port_.receive()) {
      const auto line = can::formatLogLine(static_cast<std::int64_t>(time_us), kLoopback, *frame) + "\n";
      writeText(stdout, line);
    }
  }

 private:
  can::LoopbackPort port_;
};

void runOnLoopback(const config::FingerConfig& config, const RunOptions& options) {
  can::LoopbackBus bus;
  can::LoopbackPort port(bus);
  Candump candump(bus);
  runOn(
      port, config, options, [] { return std::uint64_t{1}; },
      [&candump](std::uint64_t time_us) { candump.print(time_us); });
}

/// What is said to a node: a finger needs to hear no more.
can::BusFilter requestsTo(int node) {
  return {.id = canId(FunctionCode::kRequest, static_cast<std::uint8_t>(node)), .mask = kMaxCanId};
}

void runOnBus(const config::FingerConfig& config, const RunOptions& options) {
  const auto port = can::openBus(options.bus, config.can.bitrate, requestsTo(config.can.node));
  std::optional<system::Metronome> metronome;  // starts with the first wait, not while tables are made
  const auto wait = [&metronome] {
    if (!metronome)
      metronome.emplace(std::chrono::microseconds(simulation::SimulatedGauges::kSamplePeriod_us));
    return metronome->wait();
  };
  runOn(*port, config, options, wait, [](std::uint64_t) {});
}

void runRun(const RunOptions& options) {
  if (options.uncalibrated && options.firmware.hasTables())
    throw Failure(ExitCode::kUsage, "run: --uncalibrated makes tables of its own: leave --tables out");
  if (options.rows_hz && options.strainsPath.empty() && options.touchesPath.empty())
    throw Failure(ExitCode::kUsage, "run: --rows-hz is of --strains and --touches: give one of them");
  for (const std::string& path : options.pictures)
    options.common.requireNoneNamed("--picture", plot::filesBeside(path, plot::kTouchData));
  const config::FingerConfig config = options.config();
  if (options.isLoopback()) return runOnLoopback(config, options);
  runOnBus(config, options);
}

}  // namespace

void addRun(CLI::App& app) { addCommand<RunOptions>(app, "run", kRunHelp, runRun); }

}  // namespace strainfinger::cli
