#pragma once
// Table images as files, and as C++ source for linking one into a firmware.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/table_image.hpp"
#include "host/base/table_writer.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::tables {

/// A file's image, whole and checked. Throws Failure: kFailure if it can't be read, kMismatch if it is of
/// another format, kVerificationFailed if it is damaged. On the heap, for its size.
std::unique_ptr<TableImage> readTableFile(const std::string& path);

/// Throws Failure(kMismatch) naming every parameter in which the image differs from what the config would
/// give.
void requireTablesOf(const TableImage& image, const config::FingerConfig& config, const std::string& path);

/// One parameter of an image, as finger.toml names and writes it.
struct Parameter {
  std::string key;
  std::optional<Cell> value;  ///< nothing: not known
};
inline constexpr const char* kUnknownParameter = "unknown";
std::vector<Parameter> parametersOf(const TableParameters& parameters);
/// Where the gauges are, as calibrated, to 6 digits.
Parameter anglesOf(const GaugeAngles& angles_q32, int count);
/// The gains as the image has them, to 4 digits; an empty list if not calibrated. Where depths are known a
/// gain is calibration.gain times what the gauge's depth adds, and named so.
Parameter gainsOf(const TableImage& image);

/// Depths as the image has them, to 3 digits; an empty list if not calibrated.
Parameter depthsOf(const GaugeDepths& depths, int count);

/// The bytes of an image: a file's content.
std::string imageBytes(const TableImage& image);

/// A C++ header that defines `strainfinger::kDefaultTableBytes`, the image's bytes:
/// `constinit const TableImage kTables = std::bit_cast<TableImage>(kDefaultTableBytes);` puts them into a
/// firmware's flash.
std::string imageHeader(const TableImage& image);

}  // namespace strainfinger::tables
