#include <fmt/format.h>

#include <array>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/contact.hpp"
#include "common/fixed_real.hpp"
#include "firmware/core/condition.hpp"
#include "firmware/core/detect.hpp"
#include "firmware/core/estimate.hpp"
#include "firmware/core/left_out.hpp"
#include "firmware/core/locate.hpp"
#include "host/base/no_value.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/firmware_options.hpp"
#include "host/cli/strain_rows.hpp"
#include "host/simulation/converter.hpp"
#include "host/tables/gauge_gains.hpp"
#include "host/tables/readings.hpp"

namespace strainfinger::cli {
namespace {

using firmware::Fit;
using firmware::FitMode;
using firmware::GaugeSet;

constexpr const char* kLocateHelp =
    "Where a finger is touched and how hard, from rows of gauge strains on stdin, by the firmware's own "
    "code.\n"
    "stdin: CSV, one strain a gauge in a row, a row a sample; a header row, blank lines and # comments "
    "are passed over. Gains that the tables have from a calibration are applied to them. A reading at the "
    "end of the converter's range (gauges.full_scale_strain) or beyond is left out and the contact found by "
    "the others, as the firmware does.\n"
    "stdout: one row a sample, of\n"
    "  contact: 1 or 0; where it is 0, or too few readings are left to tell where, the others are empty\n"
    "  angle_deg: degrees, 0 to 360\n"
    "  normal_n_per_m, tangential_n_per_m: N/m\n"
    "  sigma_angle_deg, sigma_normal_n_per_m, sigma_tangential_n_per_m: standard errors, in the same units\n"
    "  quality: percent, 20 or less when the answer is uncertain (another angle fits as well, or none fits)";

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

std::vector<Cell> nothingBut(bool contact) {
  return {std::int64_t{contact}, kNoValue, kNoValue, kNoValue, kNoValue, kNoValue, kNoValue, kNoValue};
}

/// The gauges that the finger's converter has at a rail, where they may read anything beyond.
class Rails {
 public:
  explicit Rails(const TableImage& image) : constants_(image.constants), converter_(gaugesOf(image)) {}

  /// `strains`: before gains.
  GaugeSet of(std::span<const double> strains) const {
    std::array<std::uint16_t, kMaxGauges> codes{};
    for (std::size_t i = 0; i < strains.size(); ++i) codes[i] = converter_.codeOf(strains[i]);
    return firmware::saturatedGauges(constants_, firmware::Codes(codes).first(strains.size()));
  }

 private:
  static config::Gauges gaugesOf(const TableImage& image) {
    config::Gauges gauges;
    gauges.full_scale_strain = image.parameters.full_scale_strain;
    gauges.adc_bits = image.parameters.adc_bits;
    return gauges;
  }

  const TableConstants& constants_;
  simulation::Converter converter_;
};

/// Nothing when what is left of the readings could be noise. `energy`: gateEnergy() of all of them.
std::optional<Fit> fitTo(const TableImage& image, FitMode mode, GaugeSet leftOut,
                         std::span<std::int32_t> strains_q32, std::uint32_t energy) {
  if (leftOut == 0) return firmware::locate(image, mode, strains_q32, energy);
  for (std::size_t i = 0; i < strains_q32.size(); ++i)
    if (firmware::contains(leftOut, static_cast<int>(i))) strains_q32[i] = 0;
  const std::uint32_t energyLeft = firmware::gateEnergy(image.constants, strains_q32);
  if (!firmware::ContactGate{}.passes(image.constants, energyLeft)) return std::nullopt;
  return firmware::locateWithout(image, leftOut, strains_q32, energyLeft);
}

void runLocate(const LocateOptions& options) {
  const auto image = tablesFor(options);
  const TableConstants& constants = image->constants;
  NumberRowReader rows(std::cin, "stdin", constants.gauge_count, strainLimit());
  TableWriter table(stdout, options.common.format(),
                    {"contact", "angle_deg", "normal_n_per_m", "tangential_n_per_m", "sigma_angle_deg",
                     "sigma_normal_n_per_m", "sigma_tangential_n_per_m", "quality"});
  const Rails rails(*image);
  firmware::ContactGate gate;
  std::vector<std::int32_t> strains(constants.gauge_count);
  const auto factors = tables::correctionFactors(image->gains, constants.gauge_count);
  for (std::vector<double> row; rows.next(row);) {
    for (std::size_t i = 0; i < row.size(); ++i)
      strains[i] = tables::readingOf(constants, factors[i] * row[i]);
    const std::uint32_t energy = firmware::gateEnergy(constants, strains);
    const bool touched = gate.update(constants, energy);
    std::optional<Fit> fit;
    if (touched) fit = fitTo(*image, options.firmware.mode(), rails.of(row), strains, energy);
    table.row(fit ? cellsOf(firmware::estimate(constants, *fit)) : nothingBut(touched));
  }
}

}  // namespace

void addLocate(CLI::App& app) { addCommand<LocateOptions>(app, "locate", kLocateHelp, runLocate); }

}  // namespace strainfinger::cli
