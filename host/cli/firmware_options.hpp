#pragma once
// What subcommands that run the firmware's stages share: its tables and how it fits.

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "common/table_image.hpp"
#include "firmware/core/locator.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::cli {

class FirmwareOptions {
 public:
  explicit FirmwareOptions(CLI::App& command);

  /// The image of --tables, whole; else one made from the config, and checked as `tables` does.
  std::unique_ptr<TableImage> tables(const config::FingerConfig& config) const;
  /// The same; throws Failure(kMismatch) when the image is of another finger than the config's.
  std::unique_ptr<TableImage> tablesOf(const config::FingerConfig& config) const;
  bool hasTables() const { return !tablesPath_.empty(); }
  firmware::FitMode mode() const { return mode_; }
  /// Where the fit takes for a line what may be wide.
  void warnOfMode(const char* command, const TableImage& image) const;

 private:
  std::string tablesPath_;
  firmware::FitMode mode_ = firmware::FitMode::kRefined;
};

}  // namespace strainfinger::cli
