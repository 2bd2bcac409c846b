#include "host/calibration/calibrate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "common/commands.hpp"
#include "host/base/angles.hpp"
#include "host/base/atomic_file.hpp"
#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/base/no_value.hpp"
#include "host/base/notice.hpp"
#include "host/base/read_file.hpp"
#include "host/base/strain_rows.hpp"
#include "host/base/utc_text.hpp"
#include "host/calibration/complaints.hpp"
#include "host/calibration/expected_error.hpp"
#include "host/calibration/findings.hpp"
#include "host/calibration/page.hpp"
#include "host/calibration/report.hpp"
#include "host/calibration/row_use.hpp"
#include "host/cli/bus_option.hpp"
#include "host/cli/calibrate_live.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/request.hpp"
#include "host/config/write_config.hpp"
#include "host/live/terminal.hpp"
#include "host/model/pressure_profile.hpp"
#include "host/plot/picture.hpp"
#include "host/session/recorded.hpp"
#include "host/tables/self_check.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kCalibrateHelp =
    "Estimates the finger as it was built from touches by hand, of unknown places and loads: gain, zero, "
    "angle and depth of each gauge, core radius, Poisson's ratio, shear modulus, together with place, loads "
    "and width of every touch.\n"
    "--can: guided, with the finger on a bus: it says what to do next (leave it alone, roll it here, press "
    "it there with a known load, press it at a mark), shows what is covered and known, and ends when nothing "
    "is left to gain. Keys: l keeps what is held and enters its load, a its angle, u takes the last of these "
    "back, s skips what you cannot do, t takes a new zero (asks first), q ends. Where stdout is no terminal, "
    "and with --plain, lines on stderr; lines on stdin say load 200 g, angle 40, hold, undo, skip, tare or "
    "quit. The rows are kept beside -o as they come, in NAME.strains.csv and NAME.touches.csv, which "
    "--strains and --touches read; the same command goes on with them. NAME.session.toml holds the config of "
    "these rows; a session with another [finger] or [gauges] is refused. The finger is only asked for its "
    "readings (RAW); it takes a new zero only if you agree.\n"
    "--strains: CSV, one strain a gauge in a row, as `strains` prints them, without an earlier calibration; "
    "hundreds of rows, all around the finger; or a recording of a bus with RAW in it, as `record` writes, of "
    "which the touches that differ are taken. --touches: CSV with angle_deg, normal_n_per_m and "
    "tangential_n_per_m of each of these rows; an empty cell is unknown, both loads 0 are the untouched "
    "finger. A header row, blank lines and # comments are passed over.\n"
    "stdout: one row a gauge; with --summary one row of the rubber's values and of the errors to "
    "expect; with --rows how each row of strains was used; with --correlations the pairs of unknowns that "
    "are strongly correlated. "
    "stderr: the same in words.\n"
    "-o writes the config with all of it in [finger], [calibration] and gauges.model_error; [tolerance] says "
    "how far a finger may be off the drawing.\n"
    "Exit status 1 if the touches don't determine the finger (the message names the gauges and the touches "
    "that are missing), or if this finger doesn't explain the strains.";

struct CalibrateOptions {
  explicit CalibrateOptions(CLI::App& command) : common(command) {
    auto* const bus = addBusOption(command, live.bus);
    auto* const strains =
        command.add_option("--strains", strainsPath, "What the gauges read; stdin without it")
            ->type_name("FILE")
            ->excludes(bus);
    auto* const touches =
        command
            .add_option("--touches", touchesPath,
                        "What is known of what pressed, a row for each row of strains; without it nothing")
            ->type_name("FILE")
            ->excludes(bus);
    auto* const output = command.add_option("-o,--output", outputPath, "Writes the calibrated config there")
                             ->type_name("FILE.toml");
    bus->needs(output)->excludes(strains)->excludes(touches);
    command.add_option("-n,--node", node, "Of --can and of recordings: node number in place of the config's")
        ->check(isNode());
    addInterfaceOption(command, interface)->needs(strains);
    command
        .add_option("--rate", live.rate_hz,
                    fmt::format("Of --can: sample sets a second (default {})", live.rate_hz))
        ->type_name("HZ")
        ->check(isWhole(10, int{kFastestRaw_hz}))
        ->needs(bus);
    command.add_flag("--plain", live.plain, "Of --can: lines, even in a terminal")->needs(bus);
    command.add_option("--page", pagePath, "Writes a page with pictures there; needs gnuplot")
        ->type_name("FILE.html");
    command
        .add_option("--load-error", errors.load,
                    "Standard deviation of known loads, relative to the normal load")
        ->type_name("SHARE")
        ->capture_default_str()
        ->check(isFrom(0, 1));
    command.add_option("--angle-error-deg", errors.angle_deg, "Standard deviation of known angles")
        ->type_name("DEG")
        ->capture_default_str()
        ->check(isFrom(0, 90));
    auto* const whole = command.add_flag("--summary", summary, "Prints one row of the whole finger");
    auto* const each =
        command.add_flag("--rows", rows, "Prints what became of each row of strains")->excludes(whole);
    command
        .add_flag("--correlations", correlations,
                  "Prints the pairs of unknowns whose correlation is beyond 0.9")
        ->excludes(whole)
        ->excludes(each);
  }
  CommonOptions common;
  std::string touchesPath;
  std::string strainsPath;
  std::string outputPath;
  LiveCalibration live;
  int node = 0;           ///< 0: the config's
  std::string interface;  ///< of a recording; empty: all
  std::string pagePath;
  calibration::KnownErrors errors;
  bool summary = false;
  bool rows = false;
  bool correlations = false;
};

using Rows = std::vector<std::vector<double>>;

Rows readRows(std::istream& stream, const std::string& name, std::size_t columns,
              const NumberRowReader::Limit& limit) {
  NumberRowReader reader(stream, name, columns, limit);
  Rows rows;
  for (std::vector<double> row; reader.next(row);) rows.push_back(row);
  if (!reader.otherNames().empty())
    tell("calibrate: of {} only the strains are used, not {}\n", name, excerptNames(reader.otherNames()));
  return rows;
}

/// Of a file, or of stdin for no path.
Rows readRows(const std::string& path, std::size_t columns, const NumberRowReader::Limit& limit) {
  if (path.empty()) return readRows(std::cin, "stdin", columns, limit);
  std::istringstream text(readFile(path, ExitCode::kFailure));
  return readRows(text, path, columns, limit);
}

std::vector<calibration::KnownTouch> readTouches(const std::string& path) {
  std::vector<calibration::KnownTouch> touches;
  if (path.empty()) return touches;
  std::istringstream text(readFile(path, ExitCode::kFailure));
  NumberRowReader reader(text, path, 3, touchLimit());
  for (std::vector<double> row; reader.next(row);) {
    touches.push_back({valueOf(row[0]), valueOf(row[1]), valueOf(row[2])});
    calibration::requireTouch(touches.back(), fmt::format("{}: touch {}", reader.place(), touches.size()));
  }
  if (reader.isCut())
    touches.emplace_back();  // of its row of strains, which is written before, nothing is known
  return touches;
}

/// Who forgot an option would wait for a program that waits for rows.
void tellIfTyped(const std::string& strainsPath) {
  if (strainsPath.empty() && live::isKeyboard())
    tell(
        "calibrate: reading rows of strains from the terminal, up to Ctrl-D; --strains FILE reads a file, "
        "--can BUS a finger\n");
}

Eigen::MatrixXd readStrains(const std::string& path, int gauges) {
  const Rows rows = readRows(path, static_cast<std::size_t>(gauges), strainLimit(gauges));
  Eigen::MatrixXd strains(static_cast<Eigen::Index>(rows.size()), gauges);
  for (std::size_t i = 0; i < rows.size(); ++i)
    strains.row(static_cast<Eigen::Index>(i)) = Eigen::Map<const Eigen::RowVectorXd>(rows[i].data(), gauges);
  return strains;
}

/// A value and its sigma.
void addEstimate(NamedRow& row, const std::string& column, const calibration::Estimate& estimate) {
  row.push_back({column, estimate.value});
  row.push_back({"sigma_" + column, estimate.sigma});
}

NamedRow gaugeRow(const calibration::CalibrationResult& result, int gauge) {
  NamedRow row{{"gauge", std::int64_t{gauge}},
               {"angle_deg", result.drawing().config().gauges.angle_deg(gauge)}};
  addEstimate(row, "gain", result.gain(gauge));
  addEstimate(row, "zero_strain", result.zero_strain(gauge));
  addEstimate(row, "angle_offset_deg", result.angleOffset_deg(gauge));
  addEstimate(row, "depth_offset_m", result.depthOffset_m(gauge));
  row.push_back({"residual_strain", result.residual_strain(gauge)});
  return row;
}

void printGauges(TableFormat format, const calibration::CalibrationResult& result) {
  TableWriter table(stdout, format, columnsOf(gaugeRow(result, 0)));
  for (int i = 0; i < result.drawing().gauges(); ++i) table.row(valuesOf(gaugeRow(result, i)));
}

/// Errors to expect of place and loads; `when` is part of their columns' names.
void addErrors(NamedRow& row, const char* when, const Eigen::Vector3d& errors) {
  row.push_back({fmt::format("arc_{}_m", when), errors[0]});
  row.push_back({fmt::format("normal_{}_n_per_m", when), errors[1]});
  row.push_back({fmt::format("tangential_{}_n_per_m", when), errors[2]});
}

void printSummary(TableFormat format, const calibration::CalibrationResult& result) {
  NamedRow row;
  addEstimate(row, "core_radius_m", result.coreRadius_m());
  addEstimate(row, "poisson_ratio", result.poissonRatio());
  addEstimate(row, "shear_modulus_pa", result.shearModulus_pa());
  addEstimate(row, "model_error", result.modelError());
  for (const auto& words : calibration::kRowUses)
    row.push_back({calibration::columnOf(words.use), std::int64_t{result.count(words.use)}});
  const auto errors = calibration::expectedErrors(result);
  addErrors(row, "before", errors.before);
  addErrors(row, "after", errors.after);
  addErrors(row, "bound", errors.bound);
  TableWriter(stdout, format, columnsOf(row)).row(valuesOf(row));
}

void printRows(TableFormat format, const calibration::CalibrationResult& result) {
  TableWriter table(stdout, format,
                    {"row", "use", "angle_deg", "normal_n_per_m", "tangential_n_per_m", "width_m",
                     "chi_squared", "residual_drawn_strain", "residual_strain"});
  const calibration::Residuals residuals = residualsOf(result);
  const double radius_m = result.drawing().config().finger.outer_radius_m;
  for (std::size_t i = 0; i < result.rows().size(); ++i) {
    const calibration::RowResult& row = result.rows()[i];
    const auto known = [&](double value) { return Cell{calibration::isTouch(row) ? value : kNoValue}; };
    table.row({static_cast<std::int64_t>(i + 1), std::string(nameOf(row.use)),
               known(degreesOf(row.touch[calibration::kPlace])), known(row.touch[calibration::kNormalLoad]),
               known(row.touch[calibration::kTangentialLoad]),
               known(radius_m * model::uniformWidth_rad(row.touch[calibration::kMoment])),
               known(row.chiSquared), residuals.rows[i].before_strain, residuals.rows[i].after_strain});
  }
}

void printCorrelations(TableFormat format, const calibration::CalibrationResult& result) {
  TableWriter table(stdout, format, {"one", "other", "correlation"});
  for (const calibration::Correlation& each : correlationsWorthKnowing(result))
    table.row({each.one, each.other, each.value});
}

void print(const CalibrateOptions& options, const calibration::CalibrationResult& result) {
  const TableFormat format = options.common.format();
  if (options.summary) return printSummary(format, result);
  if (options.rows) return printRows(format, result);
  if (options.correlations) return printCorrelations(format, result);
  printGauges(format, result);
}

/// Why the firmware cannot work with a finger; empty if it can.
std::string whyNoTables(const config::FingerConfig& config) {
  try {
    tables::buildCheckedTables(config);
    return {};
  } catch (const Failure& failure) {
    return failure.what();
  }
}

/// The finger that was found. Where gauges came out so that the firmware's first guess may fail to explain
/// what it reads as exactly as the model error that was found allows, with the least larger one that it can
/// work with: a user would else learn it only from `tables`, with the finger put away.
config::FingerConfig workableFinger(const calibration::CalibrationResult& result) {
  config::FingerConfig found = result.applied();
  const std::string whyNot = whyNoTables(found);
  if (whyNot.empty()) return found;
  for (const double larger : {0.001, 0.002, 0.005, 0.01, 0.02}) {
    config::FingerConfig config = found;
    config.gauges.model_error = larger;
    if (larger <= found.gauges.model_error || !whyNoTables(config).empty()) continue;
    warn("calibrate",
         fmt::format("gauges.model_error has to be {}, so that errors are told larger than they are: "
                     "with the {:.2g} that was "
                     "found the firmware refuses this finger: {}",
                     larger, found.gauges.model_error, whyNot.substr(0, whyNot.find('\n'))));
    return config;
  }
  warn("calibrate", fmt::format("the firmware cannot work with this finger: {}", whyNot));
  return found;
}

/// The config first: it is what the touches were for, and the rest can fail.
void report(const CalibrateOptions& options, const calibration::CalibrationResult& result,
            const std::string& strainsPath, const std::string& touchesPath) {
  const config::FingerConfig found = workableFinger(result);
  if (!options.outputPath.empty()) writeFileAtomically(options.outputPath, config::writeConfig(found));
  print(options, result);
  const std::string told = calibration::textReport(result);
  tell(touchesPath.empty() ? told : calibration::ofFile(told, touchesPath));
  if (options.pagePath.empty()) return;
  writeFileAtomically(options.pagePath,
                      calibration::htmlPage(result, {strainsPath, touchesPath, utcText(now_ns())}));
}

void runLiveCalibration(const CalibrateOptions& options, const config::FingerConfig& config) {
  LiveCalibration live = options.live;
  live.node = nodeOf(options.node, config.can);
  live.outputPath = options.outputPath;
  live.errors = options.errors;
  const LiveResult ended = calibrateLive(config, live);
  try {
    if (ended.result) report(options, *ended.result, ended.strainsPath, ended.touchesPath);
  } catch (const Failure& failure) {
    throw Failure(failure.code(), fmt::format("{}; {}", failure.what(), ended.kept));
  }
  if (ended.interrupted) throw Failure(ExitCode::kInterrupted, "calibrate: interrupted; " + ended.kept);
  if (!ended.result) throw Failure(ExitCode::kFailure, fmt::format("{}; {}", ended.complaint, ended.kept));
  tell("calibrate: {}\n", ended.kept);
}

Eigen::MatrixXd strainsOfRecording(const CalibrateOptions& options, const config::FingerConfig& config) {
  if (!options.touchesPath.empty())
    throw Failure(
        ExitCode::kUsage,
        fmt::format(
            "{} is a recording, of whose readings `calibrate` chooses the rows: leave --touches out, or "
            "give rows as `strains` prints them",
            options.strainsPath));
  const auto recorded = session::readRecording(options.strainsPath, config, nodeOf(options.node, config.can),
                                               options.interface);
  tell("calibrate: {} of {} sample sets are touches that differ\n", recorded.rows.size(), recorded.sets);
  warn("calibrate", recorded.warnings);
  return recorded.rows.matrix();
}

calibration::CalibrationResult calibrated(const CalibrateOptions& options, const config::FingerConfig& config,
                                          const std::vector<calibration::KnownTouch>& known,
                                          const Eigen::MatrixXd& strains) {
  try {
    return calibration::calibrate(config, known, strains, options.errors);
  } catch (const Failure& failure) {
    if (known.empty()) throw;
    throw Failure(failure.code(), calibration::ofFile(failure.what(), options.touchesPath));
  }
}

void runCalibrate(const CalibrateOptions& options) {
  const config::FingerConfig config = options.common.config();
  requireFolderOf("--page", options.pagePath);
  if (!options.pagePath.empty()) plot::requireGnuplot();
  requireFolderOf("--output", options.outputPath);
  if (!options.live.bus.empty()) return runLiveCalibration(options, config);
  const bool isRecording = !options.strainsPath.empty() && session::isRecording(options.strainsPath);
  if (!options.interface.empty() && !isRecording)
    throw Failure(ExitCode::kUsage, fmt::format("calibrate: --interface is for recordings, which {} is not",
                                                options.strainsPath));
  tellIfTyped(options.strainsPath);
  const auto known = isRecording ? std::vector<calibration::KnownTouch>{} : readTouches(options.touchesPath);
  const auto strains = isRecording ? strainsOfRecording(options, config)
                                   : readStrains(options.strainsPath, config.gauges.count);
  report(options, calibrated(options, config, known, strains), options.strainsPath, options.touchesPath);
}

}  // namespace

void addCalibrate(CLI::App& app) {
  addCommand<CalibrateOptions>(app, "calibrate", kCalibrateHelp, runCalibrate);
}

}  // namespace strainfinger::cli
