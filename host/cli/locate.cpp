#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/contact.hpp"
#include "common/fixed_real.hpp"
#include "common/frames.hpp"
#include "firmware/core/condition.hpp"
#include "firmware/core/detect.hpp"
#include "firmware/core/estimate.hpp"
#include "firmware/core/locator.hpp"
#include "host/base/failure.hpp"
#include "host/base/no_value.hpp"
#include "host/base/strain_rows.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/firmware_options.hpp"
#include "host/config/over_range.hpp"
#include "host/tables/gauge_gains.hpp"
#include "host/tables/readings.hpp"

namespace strainfinger::cli {
namespace {

using firmware::Answer;
using firmware::GaugeSet;

constexpr const char* kLocateHelp =
    "Where a finger is touched and how hard, from rows of gauge strains on stdin, by the firmware's own "
    "code.\n"
    "stdin: CSV, one strain a gauge in a row, a row a sample; blank lines and # comments are passed over. "
    "With a header row the gauges' columns are strain_0, strain_1 .., and other columns, such as time_s, are "
    "passed through: they come first, those named as a column of stdout as input_NAME. Gains that the tables "
    "have from a calibration are applied to them. A "
    "reading within 5 % of the end of the converter's range (gauges.full_scale_strain; zeros move it) or "
    "beyond is left out and the contact found by the others, as the firmware does, which knows the rails "
    "themselves.\n"
    "stdout: one row a sample, of\n"
    "  contact: 1 or 0; where it is 0, or too few readings are left to tell where, the others are empty\n"
    "  angle_deg: degrees, 0 to 360\n"
    "  normal_n_per_m, tangential_n_per_m: N/m\n"
    "  sigma_angle_deg, sigma_normal_n_per_m, sigma_tangential_n_per_m: standard errors, in the same units\n"
    "  quality: percent, of this contact; 20 or less when it is uncertain (another angle fits as well, or "
    "none fits)\n"
    "  width_m, sigma_width_m: of the uniform pressure with the same second moment; empty where the width is "
    "known (contact.width_m)\n"
    "  flags: as in CONTACT, joined by +\n"
    "  angle2_deg, normal2_n_per_m, tangential2_n_per_m: of a second contact; empty where there is none";

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

Cell widthCell(std::uint32_t width_um) {
  return width_um == kWidthNotFitted ? kNoValue : Cell{1e-6 * width_um};
}

FingerFlags flagsOf(const Answer& answer, const std::vector<Contact>& contacts, GaugeSet saturated,
                    GaugeSet all) {
  FingerFlags flags{FingerFlag::kContact};
  for (const Contact& contact : contacts)
    if (contact.uncertain) flags.set(FingerFlag::kUncertain);
  flags.set(FingerFlag::kSaturated, saturated != 0);
  flags.set(FingerFlag::kDegraded, (all & ~answer.solution.hypothesis.gauges & ~saturated) != 0);
  flags.set(FingerFlag::kSeveralContacts, answer.several || contacts.size() > 1);
  return flags;
}

NamedRow locatedRow(const std::vector<Contact>& contacts, FingerFlags flags) {
  const Contact& contact = contacts.front();
  const Contact second = contacts.size() > 1 ? contacts[1] : Contact{};
  const auto ofSecond = [&](double value) { return contacts.size() > 1 ? value : kNoValue; };
  return {{"contact", std::int64_t{1}},
          {"angle_deg", degrees(contact.angle)},
          {"normal_n_per_m", toReal(contact.normal)},
          {"tangential_n_per_m", toReal(contact.tangential)},
          {"sigma_angle_deg", degrees(contact.sigmaAngle)},
          {"sigma_normal_n_per_m", toReal(contact.sigmaNormal)},
          {"sigma_tangential_n_per_m", toReal(contact.sigmaTangential)},
          {"quality", std::int64_t{contact.quality}},
          {"width_m", widthCell(contact.width_um)},
          {"sigma_width_m", widthCell(contact.sigmaWidth_um)},
          {"flags", can::flagsText(kFingerFlagNames, flags.raw())},
          {"angle2_deg", ofSecond(degrees(second.angle))},
          {"normal2_n_per_m", ofSecond(toReal(second.normal))},
          {"tangential2_n_per_m", ofSecond(toReal(second.tangential))}};
}

std::vector<std::string> columnsOfLocated() { return columnsOf(locatedRow({Contact{}}, {})); }

std::vector<Cell> nothingBut(bool contact) {
  std::vector<Cell> cells(columnsOfLocated().size(), kNoValue);
  cells.front() = std::int64_t{contact};
  return cells;
}

/// The gauges that may be at the end of their range. `strains`: before gains.
GaugeSet overRange(const TableImage& image, std::span<const double> strains) {
  config::Gauges gauges;
  gauges.full_scale_strain = image.parameters.full_scale_strain;
  GaugeSet over = 0;
  for (std::size_t i = 0; i < strains.size(); ++i)
    if (config::isOverRange(gauges, strains[i])) over |= GaugeSet{1} << i;
  return over;
}

/// Every gauge at a rail should read as much as it does, or more.
bool areRailsPlausible(const firmware::Locator& locator, std::span<const std::int32_t> strains_q32,
                       GaugeSet saturated) {
  for (std::size_t i = 0; i < strains_q32.size(); ++i)
    if (firmware::contains(saturated, static_cast<int>(i)) &&
        !firmware::isRailPlausible(strains_q32[i] >> locator.answer().shift,
                                   locator.linearisation().predicted[i]))
      return false;
  return true;
}

/// The row of what the firmware finds.
std::vector<Cell> located(const TableImage& image, firmware::Locator& locator,
                          std::span<const std::int32_t> strains_q32, GaugeSet saturated) {
  const GaugeSet all = firmware::allGauges(image.constants.gauge_count);
  firmware::locateOnce(image, strains_q32, all & ~saturated, locator);
  const Answer& answer = locator.answer();
  std::vector<Contact> contacts;
  for (int i = 0; i < answer.solution.hypothesis.contacts; ++i)
    contacts.push_back(
        firmware::estimate(image.constants, answer, firmware::unitErrors(locator.linearisation()), i));
  if (!areRailsPlausible(locator, strains_q32, saturated))
    for (Contact& contact : contacts) {
      contact.uncertain = true;
      contact.quality = std::min(contact.quality, firmware::kMostUncertainQuality);
    }
  return valuesOf(locatedRow(contacts, flagsOf(answer, contacts, saturated, all)));
}

/// A number, where the text is one as JSON writes it. What a reader would find changed stays text: 007, 12e4
/// (which may be no number), and more digits than 64 bits hold.
Cell asNumber(const std::string& text) {
  constexpr std::uint64_t kMostWhole = std::numeric_limits<std::int64_t>::max();
  const auto number = nlohmann::json::parse(text, nullptr, false);
  const bool isTooLong = number.is_number_unsigned() && number.get<std::uint64_t>() > kMostWhole;
  if (number.is_number_integer() && !isTooLong) return number.get<std::int64_t>();
  return number.is_number_float() && text.find('.') != text.npos ? Cell(number.get<double>()) : Cell(text);
}

/// As they were; numbers are numbers in JSON.
std::vector<Cell> passedThrough(const std::vector<std::string>& texts, TableFormat format) {
  std::vector<Cell> cells;
  for (const std::string& text : texts)
    cells.push_back(format == TableFormat::kJson ? asNumber(text) : Cell(text));
  return cells;
}

std::vector<std::string> columnsBehind(std::vector<std::string> columns) {
  const std::vector<std::string> own = columnsOfLocated();
  for (std::string& column : columns)
    if (std::ranges::find(own, column) != own.end()) column.insert(0, "input_");
  for (auto column = columns.begin(); column != columns.end(); ++column)
    if (std::find(columns.begin(), column, *column) != column)
      throw Failure(ExitCode::kFailure,
                    fmt::format("stdin: two columns would be passed through as {}: rename one", *column));
  columns.insert(columns.end(), own.begin(), own.end());
  return columns;
}

void runLocate(const LocateOptions& options) {
  const auto image = tablesFor(options);
  options.firmware.warnOfMode("locate", *image);
  const TableConstants& constants = image->constants;
  NumberRowReader rows(std::cin, "stdin", constants.gauge_count, strainLimit(constants.gauge_count));
  firmware::ContactGate gate;
  firmware::Locator locator(options.firmware.mode());
  std::vector<std::int32_t> strains(constants.gauge_count);
  const auto factors = tables::correctionFactors(image->gains, constants.gauge_count);
  std::vector<double> row;
  bool more = rows.next(row);
  TableWriter table(stdout, options.common.format(), columnsBehind(rows.otherNames()));
  for (; more; more = rows.next(row)) {
    for (std::size_t i = 0; i < row.size(); ++i)
      strains[i] = tables::readingOf(constants, factors[i] * row[i]);
    const bool touched = gate.update(constants, firmware::gateEnergy(constants, strains));
    const GaugeSet saturated = touched ? overRange(*image, row) : 0;
    const bool enough = std::popcount(saturated) * 2 <= constants.gauge_count;
    std::vector<Cell> cells = passedThrough(rows.others(), options.common.format());
    for (Cell& cell : touched&& enough ? located(*image, locator, strains, saturated) : nothingBut(touched))
      cells.push_back(std::move(cell));
    table.row(cells);
  }
}

}  // namespace

void addLocate(CLI::App& app) { addCommand<LocateOptions>(app, "locate", kLocateHelp, runLocate); }

}  // namespace strainfinger::cli
