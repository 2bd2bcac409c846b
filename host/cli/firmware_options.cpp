#include "host/cli/firmware_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "host/cli/command.hpp"
#include "host/tables/self_check.hpp"
#include "host/tables/table_file.hpp"
#include "host/tables/table_text.hpp"

namespace strainfinger::cli {

using firmware::FitMode;

namespace {

constexpr std::array kModes{std::pair{std::string_view("refined"), FitMode::kRefined},
                            std::pair{std::string_view("three-point"), FitMode::kThreePoint}};

/// From a mode's name to its number. CLI11's own transformers show users the numbers as well.
std::string toMode(std::string& name) {
  const auto mode =
      std::find_if(kModes.begin(), kModes.end(), [&](const auto& known) { return known.first == name; });
  if (mode == kModes.end())
    return fmt::format("{} is not one of {}, {}", name, kModes[0].first, kModes[1].first);
  name = std::to_string(static_cast<int>(mode->second));
  return {};
}

}  // namespace

FirmwareOptions::FirmwareOptions(CLI::App& command) {
  command.add_option("--tables", tablesPath_, "Table image (tables -o); made from the config without it")
      ->type_name("FILE");
  command
      .add_option(
          "--mode", mode_,
          "How it fits: refined (default), or three-point, for contacts of a known width (contact.width_m)")
      ->type_name("MODE")
      ->transform(CLI::Validator(toMode, ""));
}

std::unique_ptr<TableImage> FirmwareOptions::tables(const config::FingerConfig& config) const {
  if (tablesPath_.empty()) return std::make_unique<TableImage>(tables::buildCheckedTables(config).image);
  return tables::readTableFile(tablesPath_);
}

std::unique_ptr<TableImage> FirmwareOptions::tablesOf(const config::FingerConfig& config) const {
  auto image = tables(config);
  tables::requireTablesOf(*image, config, tablesPath_);
  return image;
}

void FirmwareOptions::warnOfMode(const char* command, const TableImage& image) const {
  if (mode_ == FitMode::kThreePoint && image.constants.width_is_known == 0)
    warn(command,
         "--mode three-point takes every contact for a line, as contact.width_m is left out: wider ones are "
         "off by several of the errors that it tells; give contact.width_m, or --mode refined");
}

}  // namespace strainfinger::cli
