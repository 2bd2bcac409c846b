#include "host/cli/firmware_options.hpp"

#include <map>

#include "host/tables/self_check.hpp"
#include "host/tables/table_file.hpp"

namespace strainfinger::cli {

using firmware::FitMode;

FirmwareOptions::FirmwareOptions(CLI::App& command) {
  command.add_option("--tables", tablesPath_, "Table image (tables -o); made from the config without it")
      ->type_name("FILE");
  const std::map<std::string, FitMode> modes{{"three-point", FitMode::kThreePoint},
                                             {"refined", FitMode::kRefined}};
  command.add_option("--mode", mode_, "three-point or refined (default)")
      ->transform(CLI::CheckedTransformer(modes).description("MODE"));
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

}  // namespace strainfinger::cli
