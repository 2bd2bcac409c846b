#pragma once
// What a table image was made from, in words.

#include <optional>
#include <string>
#include <vector>

#include "common/table_image.hpp"
#include "host/base/table_writer.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::tables {

/// One parameter of an image, as finger.toml names and writes it.
struct Parameter {
  std::string key;
  std::optional<Cell> value;  ///< nothing: not known
};
inline constexpr const char* kUnknownParameter = "unknown";

/// All of an image's. Last of them lists with a number a gauge: where it is, as calibrated, to 6 digits; its
/// gain to 4 digits and its depth to 3, which are empty lists if not calibrated. Where depths are known a
/// gain is calibration.gain times what the gauge's depth adds, and named gain_with_depth.
std::vector<Parameter> parametersOf(const TableImage& image);

/// Its value as finger.toml would have it; the shortest digits that read back exactly.
std::string textOf(const Parameter& parameter);

/// Throws Failure(kMismatch) naming every parameter in which the image differs from what the config would
/// give, and what buildTableImage() throws where the config gives none.
void requireTablesOf(const TableImage& image, const config::FingerConfig& config, const std::string& path);

}  // namespace strainfinger::tables
