#include <fmt/format.h>

#include <string>

#include "host/base/atomic_file.hpp"
#include "host/base/failure.hpp"
#include "host/base/no_value.hpp"
#include "host/base/notice.hpp"
#include "host/can/touch_receiver.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/config/ring_spacing.hpp"
#include "host/config/unseen_errors.hpp"
#include "host/tables/self_check.hpp"
#include "host/tables/table_file.hpp"
#include "host/tables/table_header.hpp"
#include "host/tables/table_text.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kTablesHelp =
    "The lookup tables of a finger: the flash image that the firmware reads, made from the elastic model.\n"
    "  tables -o FILE      makes the image of the config's finger (and --header FILE, the same as C++ "
    "source)\n"
    "  tables info FILE    what it was made from\n"
    "  tables verify FILE  whether it is whole and belongs to the config: exit status 0, 6 damaged, 5 "
    "another finger's";

struct TablesOptions {
  explicit TablesOptions(CLI::App& command) : common(command) {
    auto& image = *command.add_option("-o,--output", imagePath, "Writes the flash image there");
    auto& header = *command.add_option("--header", headerPath, "Writes the image as a C++ header there");
    command.require_subcommand(0, 1);
    auto& info = addFileCommand(command, "info",
                                "What an image was made from; gain_with_depth is calibration.gain with what "
                                "calibration.depth_offset_m adds",
                                infoPath);
    auto& check =
        addFileCommand(command, "verify", "Whether an image is whole and belongs to the config", verifyPath);
    for (CLI::Option* making : {image.type_name("FILE"), header.type_name("FILE")}) {
      info.excludes(making);
      check.excludes(making);
    }
  }
  static CLI::App& addFileCommand(CLI::App& command, const std::string& name, const std::string& help,
                                  std::string& path) {
    CLI::App& sub = *command.add_subcommand(name, help);
    sub.add_option("FILE", path, "The image")->type_name("FILE")->required();
    sub.fallthrough();  // -c and --json may stand behind FILE
    return sub;
  }

  CommonOptions common;
  std::string imagePath;
  std::string headerPath;
  std::string infoPath;
  std::string verifyPath;
};

/// What the tables are good for and the finger is not.
void warnOf(const config::FingerConfig& config, const tables::SelfCheck& check) {
  if (config::isSparse(config))
    warn(
        "tables",
        fmt::format("at the surface the gauges are up to {:.4g} times their depth apart (gauges.count, "
                    "gauges.angle_deg, gauges.radius_m); above {} times the reported standard errors are too "
                    "small between gauges, and touches cannot show which gauge fails: use more gauges, or "
                    "deeper ones",
                    config::widestGapInDepths(config), config::kSparse));
  if (const double error = config::unseenErrors(config).modelError; error > config.gauges.model_error)
    warn("tables",
         fmt::format("a depth error of tolerance.depth_m = {} m changes the readings of this "
                     "finger much, as its gauges "
                     "are near the core or the surface: until it is calibrated, the tables use a model error "
                     "of {:.2g} instead of gauges.model_error = {}, and more touches are flagged; calibrate "
                     "the finger, or enter a smaller tolerance.depth_m if it is built more accurately",
                     config.tolerance.depth_m, error, config.gauges.model_error));
  const double most_n = 2 * check.halfScale_n_per_m * config.finger.length_m;
  const double told_n = can::largestValues().normal_n;
  if (most_n > told_n)
    warn("tables",
         fmt::format("the gauges read forces up to {:.3g} N (finger.length_m = {}), FORCE tells {} N at most",
                     most_n, config.finger.length_m, told_n));
}

void make(const TablesOptions& options) {
  const config::FingerConfig config = options.common.config();
  requireFolderOf("--output", options.imagePath);
  requireFolderOf("--header", options.headerPath);
  const auto [image, check] = tables::buildCheckedTables(config);
  if (!options.imagePath.empty()) writeFileAtomically(options.imagePath, tables::imageBytes(image));
  if (!options.headerPath.empty()) writeFileAtomically(options.headerPath, tables::imageHeader(image));
  tell(
      "tables: {} bytes, {} gauges, CRC-32 {:08X}\n"
      "tables: contacts are seen from {:.2g} N/m on; of {} tried without noise {:.2g} % are uncertain, "
      "none is misplaced\n",
      sizeof(image), image.constants.gauge_count, image.crc32, check.detected_n_per_m, check.contacts,
      100.0 * check.uncertain / check.contacts);
  warnOf(config, check);
}

void showInfo(const TablesOptions& options) {
  options.common.requireGoodConfig();
  const auto image = tables::readTableFile(options.infoPath);
  TableWriter table(stdout, options.common.format(), {"key", "value"});
  table.row({"format", std::int64_t{image->format}});
  table.row({"bytes", std::int64_t{image->image_bytes}});
  table.row({"crc32", fmt::format("{:08X}", image->crc32)});
  const bool isJson = options.common.format() == TableFormat::kJson;
  const Cell unknown = isJson ? Cell(kNoValue) : Cell(tables::kUnknownParameter);
  for (const tables::Parameter& parameter : tables::parametersOf(*image))
    table.row({parameter.key, parameter.value.value_or(unknown)});
}

void verify(const TablesOptions& options) {
  const auto image = tables::readTableFile(options.verifyPath);
  tables::requireTablesOf(*image, options.common.config(), options.verifyPath);
  tell("tables: {} is whole and belongs to this finger, CRC-32 {:08X}\n", options.verifyPath, image->crc32);
}

void runTables(const TablesOptions& options) {
  if (!options.infoPath.empty()) return showInfo(options);
  if (!options.verifyPath.empty()) return verify(options);
  if (options.imagePath.empty() && options.headerPath.empty())
    throw Failure(ExitCode::kUsage, "tables: nothing to do: give -o FILE, or info FILE, or verify FILE");
  make(options);
}

}  // namespace

void addTables(CLI::App& app) { addCommand<TablesOptions>(app, "tables", kTablesHelp, runTables); }

}  // namespace strainfinger::cli
