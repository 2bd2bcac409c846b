#include "host/calibration/calibrate.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "host/base/atomic_file.hpp"
#include "host/base/failure.hpp"
#include "host/base/read_file.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/strain_rows.hpp"
#include "host/config/write_config.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kCalibrateHelp =
    "Each gauge's gain, from touches that are known: what it reads over what the elastic model gives.\n"
    "--strains: CSV, one strain a gauge in a row, as `locate` reads them, without an earlier "
    "calibration; --touches: CSV with angle_deg, normal_n_per_m and tangential_n_per_m of each of these "
    "rows. Rows with both loads 0 are of the untouched finger: with them zeros are fitted too, without "
    "them zeros are 0. A header row, blank lines and # comments are passed over.\n"
    "stdout: one row a gauge; residual_strain is the RMS of what the fit leaves. Sigmas are for the "
    "config's noise_strain, or for the residuals where these are larger.\n"
    "Exit status 1 when the touches don't tell a gain to 1 %, naming the gauges and the touches that are "
    "missing, and when touches and strains don't belong together.";

struct CalibrateOptions {
  explicit CalibrateOptions(CLI::App& command) : common(command) {
    command.add_option("--touches", touchesPath, "What pressed, a row for each row of strains")
        ->type_name("FILE")
        ->required();
    command.add_option("--strains", strainsPath, "What the gauges read; stdin without it")->type_name("FILE");
    command.add_option("-o,--output", outputPath, "Writes the config with the gains in [calibration] there")
        ->type_name("FILE");
  }
  CommonOptions common;
  std::string touchesPath;
  std::string strainsPath;
  std::string outputPath;
};

using Rows = std::vector<std::vector<double>>;

Rows readRows(std::istream& stream, const std::string& name, std::size_t columns,
              const NumberRowReader::Limit& limit) {
  NumberRowReader reader(stream, name, columns, limit);
  Rows rows;
  for (std::vector<double> row; reader.next(row);) rows.push_back(row);
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
  for (const auto& row : readRows(path, 3, {.header = "angle_deg,normal_n_per_m,tangential_n_per_m"}))
    touches.push_back({row[0], row[1], row[2]});
  return touches;
}

Eigen::MatrixXd readStrains(const std::string& path, int gauges) {
  const Rows rows = readRows(path, static_cast<std::size_t>(gauges), strainLimit(gauges));
  Eigen::MatrixXd strains(static_cast<Eigen::Index>(rows.size()), gauges);
  for (std::size_t i = 0; i < rows.size(); ++i)
    strains.row(static_cast<Eigen::Index>(i)) = Eigen::Map<const Eigen::RowVectorXd>(rows[i].data(), gauges);
  return strains;
}

void print(const CalibrateOptions& options, const config::Gauges& gauges,
           const calibration::CalibrationFit& fit) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  TableWriter table(
      stdout, options.common.format(),
      {"gauge", "angle_deg", "gain", "sigma_gain", "zero_strain", "sigma_zero_strain", "residual_strain"});
  for (int i = 0; i < gauges.count; ++i) {
    const auto& gauge = fit.gauges[static_cast<std::size_t>(i)];
    const auto zero = gauge.zero_strain.value_or(calibration::Estimate{kUnknown, kUnknown});
    table.row({std::int64_t{i}, gauges.angle_deg(i), gauge.gain.value, gauge.gain.sigma, zero.value,
               zero.sigma, gauge.residual_strain});
  }
}

/// Touches by hand are seldom better than this; more than it is worth a look.
constexpr double kRemarkableExcess = 2;

void remark(const calibration::CalibrationFit& fit) {
  if (fit.excess <= kRemarkableExcess) return;
  fmt::print(
      stderr,
      "calibrate: the residuals are {:.3g} times gauges.noise_strain, and sigmas are larger by that: the "
      "touches were not quite where or what they are said to be, or [finger] is not quite the finger\n",
      fit.excess);
}

/// To 0.0001 %, a hundredth of what a good calibration can tell.
double rounded(double gain) { return std::round(gain * 1e6) / 1e6; }

void runCalibrate(const CalibrateOptions& options) {
  config::FingerConfig config = options.common.config();
  const auto touches = readTouches(options.touchesPath);
  const auto fit =
      calibration::calibrate(config, touches, readStrains(options.strainsPath, config.gauges.count));
  print(options, config.gauges, fit);
  remark(fit);
  if (options.outputPath.empty()) return;
  config.calibration.gain.clear();
  for (const auto& gauge : fit.gauges) config.calibration.gain.push_back(rounded(gauge.gain.value));
  writeFileAtomically(options.outputPath, config::writeConfig(config));
}

}  // namespace

void addCalibrate(CLI::App& app) {
  addCommand<CalibrateOptions>(app, "calibrate", kCalibrateHelp, runCalibrate);
}

}  // namespace strainfinger::cli
