#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "common/contact.hpp"
#include "common/fixed_real.hpp"
#include "firmware/core/detect.hpp"
#include "firmware/core/estimate.hpp"
#include "firmware/core/locate.hpp"
#include "host/base/no_value.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/firmware_options.hpp"
#include "host/cli/strain_rows.hpp"
#include "host/tables/gauge_gains.hpp"
#include "host/tables/readings.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kLocateHelp =
    "Where a finger is touched and how hard, from rows of gauge strains on stdin, by the firmware's own "
    "code.\n"
    "stdin: CSV, one strain a gauge in a row, a row a sample; a header row, blank lines and # comments "
    "are passed over. Gains that the tables have from a calibration are applied to them.\n"
    "stdout: one row a sample; contact is 1 or 0, and without contact the other columns are empty.\n"
    "quality: percent, 20 or less when the answer is uncertain (another angle fits as well, or none "
    "fits).";

struct LocateOptions {
  explicit LocateOptions(CLI::App& command) : common(command), firmware(command) {}
  CommonOptions common;
  FirmwareOptions firmware;
};

std::unique_ptr<TableImage> tablesFor(const LocateOptions& options) {
  const config::FingerConfig config = options.common.config();
  return options.common.hasConfig() ? options.firmware.tablesOf(config) : options.firmware.tables(config);
}

double degrees(TurnQ32 angle) { return toReal(angle) * 360; }

std::vector<Cell> cellsOf(const Contact& contact) {
  return {std::int64_t{1},
          degrees(contact.angle),
          toReal(contact.normal),
          toReal(contact.tangential),
          degrees(contact.sigmaAngle),
          toReal(contact.sigmaNormal),
          toReal(contact.sigmaTangential),
          std::int64_t{contact.quality}};
}

std::vector<Cell> noContact() {
  return {std::int64_t{0}, kNoValue, kNoValue, kNoValue, kNoValue, kNoValue, kNoValue, kNoValue};
}

void runLocate(const LocateOptions& options) {
  const auto image = tablesFor(options);
  const TableConstants& constants = image->constants;
  NumberRowReader rows(std::cin, "stdin", constants.gauge_count, strainLimit());
  TableWriter table(stdout, options.common.format(),
                    {"contact", "angle_deg", "normal_n_per_m", "tangential_n_per_m", "sigma_angle_deg",
                     "sigma_normal_n_per_m", "sigma_tangential_n_per_m", "quality"});
  firmware::ContactGate gate;
  std::vector<std::int32_t> strains(constants.gauge_count);
  const auto factors = tables::correctionFactors(image->gains, constants.gauge_count);
  for (std::vector<double> row; rows.next(row);) {
    for (std::size_t i = 0; i < row.size(); ++i)
      strains[i] = tables::readingOf(constants, factors[i] * row[i]);
    const std::uint32_t energy = firmware::gateEnergy(constants, strains);
    const bool touched = gate.update(constants, energy);
    table.row(touched ? cellsOf(firmware::estimate(
                            constants, firmware::locate(*image, options.firmware.mode(), strains, energy)))
                      : noContact());
  }
}

}  // namespace

void addLocate(CLI::App& app) { addCommand<LocateOptions>(app, "locate", kLocateHelp, runLocate); }

}  // namespace strainfinger::cli
