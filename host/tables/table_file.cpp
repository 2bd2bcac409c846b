#include "host/tables/table_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <memory>
#include <string>
#include <variant>

#include "common/fixed_real.hpp"
#include "host/base/read_file.hpp"
#include "host/config/keys.hpp"
#include "host/tables/gauge_depths.hpp"
#include "host/tables/gauge_gains.hpp"
#include "host/tables/response_table.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger::tables {
namespace {

std::string wordsFor(TableFault fault, const TableImage& image, std::size_t bytes) {
  switch (fault) {
    case TableFault::kTooShort:
      return fmt::format("{} bytes, too short for a table image", bytes);
    case TableFault::kMagic:
      return "not a table image";
    case TableFault::kFormat:
      return fmt::format("a table image of format {}, this program and its firmware read format {}",
                         image.format, kTableFormat);
    case TableFault::kLength:
      return fmt::format("{} bytes, and {} by its header, where an image has {}", bytes, image.image_bytes,
                         sizeof(TableImage));
    case TableFault::kChecksum:
      return "damaged, its CRC-32 does not match";
    default:
      return "its constants are none that the firmware can work with";
  }
}

TableFault faultOf(const TableImage& image, std::size_t bytes) {
  if (bytes < kTableHeaderBytes) return TableFault::kTooShort;
  const TableFault fault = checkTableImage(image);
  const bool isOurs = fault != TableFault::kMagic && fault != TableFault::kFormat;
  return isOurs && bytes != sizeof(TableImage) ? TableFault::kLength : fault;
}

/// As finger.toml would have it; the shortest digits that read back exactly.
std::string textOf(const Parameter& parameter) {
  if (!parameter.value) return kUnknownParameter;
  return std::visit([](const auto& content) { return fmt::format("{}", content); }, *parameter.value);
}

/// To so many digits, as people read it.
double rounded(double value, int digits) { return std::stod(fmt::format("{:.{}g}", value, digits)); }

/// Nothing for what is no table image: nobody is told to write over it.
std::string adviceOn(TableFault fault, const std::string& path) {
  if (fault == TableFault::kTooShort || fault == TableFault::kMagic) return {};
  return fmt::format("; make it anew with: strainfinger tables [-c CONFIG] -o {}", path);
}

}  // namespace

std::unique_ptr<TableImage> readTableFile(const std::string& path) {
  const std::string bytes = readFile(path, ExitCode::kFailure);
  auto image = std::make_unique<TableImage>();
  std::memcpy(image.get(), bytes.data(), std::min(bytes.size(), sizeof(TableImage)));
  const TableFault fault = faultOf(*image, bytes.size());
  if (fault == TableFault::kNone) return image;
  throw Failure(fault == TableFault::kFormat ? ExitCode::kMismatch : ExitCode::kVerificationFailed,
                fmt::format("{}: {}{}", path, wordsFor(fault, *image, bytes.size()), adviceOn(fault, path)));
}

std::vector<Parameter> parametersOf(const TableParameters& p) {
  return {{"finger.core_radius_m", p.core_radius_m},
          {"finger.outer_radius_m", p.outer_radius_m},
          {"finger.length_m", p.length_m},
          {"finger.shear_modulus_pa", p.shear_modulus_pa},
          {"finger.poisson_ratio", p.poisson_ratio},
          {"gauges.count", std::int64_t{p.gauge_count}},
          {"gauges.radius_m", p.gauge_radius_m},
          {"gauges.component", std::string(config::componentName(p.component))},
          {"gauges.first_angle_deg", p.first_angle_deg},
          {"gauges.arc_length_m", p.arc_length_m},
          {"gauges.noise_strain", p.noise_strain},
          {"gauges.full_scale_strain", p.full_scale_strain},
          {"gauges.adc_bits", std::int64_t{p.adc_bits}},
          {"gauges.model_error", p.model_error},
          {"calibration.place_error_m", p.place_error_m},
          {"calibration.load_error", p.load_error},
          {"calibration.moment_error_m2", p.moment_error_m2},
          {"contact.friction_coefficient", p.friction_coefficient},
          {"contact.width_m", p.contact_width_m < 0 ? std::nullopt : std::optional<Cell>(p.contact_width_m)},
          {"contact.largest_width_m", p.largest_width_m}};
}

Parameter anglesOf(const GaugeAngles& angles_q32, int count) {
  std::vector<double> angles_deg;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    angles_deg.push_back(rounded(360 * toReal(TurnQ32::fromRaw(angles_q32[i])), 6));
  return {"gauges.angle_deg", angles_deg};
}

namespace {

Parameter gainsOf(const GaugeGains& gains, bool areDepthsKnown, int count) {
  std::vector<double> known;
  if (gains.areKnown())
    for (const double factor : correctionFactors(gains, count)) known.push_back(rounded(1 / factor, 4));
  return {areDepthsKnown ? "gain_with_depth" : "calibration.gain", known};
}

}  // namespace

Parameter gainsOf(const TableImage& image) {
  return gainsOf(image.gains, image.depths.areKnown(), image.constants.gauge_count);
}

Parameter depthsOf(const GaugeDepths& depths, int count) {
  std::vector<double> offsets_m;
  if (depths.areKnown())
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      offsets_m.push_back(rounded(1e-9 * depths.steps[i] * depths.step_nm, 3));
  return {"calibration.depth_offset_m", offsets_m};
}

namespace {

std::string differenceOf(const Parameter& has, const Parameter& wants) {
  return fmt::format("\n  {} is {}, the config has {}", has.key, textOf(has), textOf(wants));
}

/// Angles that differ because the ring begins elsewhere or has other gauges are told by those parameters.
bool isSameRing(const TableParameters& a, const TableParameters& b) {
  return a.gauge_count == b.gauge_count && a.first_angle_deg == b.first_angle_deg;
}

}  // namespace

void requireTablesOf(const TableImage& image, const config::FingerConfig& config, const std::string& path) {
  const TableParameters wantedParameters = tableParameters(config);
  const auto has = parametersOf(image.parameters), wants = parametersOf(wantedParameters);
  std::string differences;
  for (std::size_t i = 0; i < has.size(); ++i)
    if (has[i].value != wants[i].value) differences += differenceOf(has[i], wants[i]);
  const int count = image.parameters.gauge_count;
  const GaugeAngles wantedAngles_q32 = gaugeAngles_q32(config);
  if (isSameRing(image.parameters, wantedParameters) && image.gauge_angle_q32 != wantedAngles_q32)
    differences += differenceOf(anglesOf(image.gauge_angle_q32, count), anglesOf(wantedAngles_q32, count));
  const DepthFit wantedDepths = depthFit(config);
  const GaugeDepths depths = gaugeDepths(wantedDepths, responseTable(config, wantedDepths.growth));
  const bool areDepthsKnown = image.depths.areKnown() || depths.areKnown();
  if (const GaugeGains wanted = gaugeGains(config, wantedDepths); image.gains != wanted)
    differences += differenceOf(gainsOf(image.gains, areDepthsKnown, count),
                                gainsOf(wanted, areDepthsKnown, config.gauges.count)) +
                   (areDepthsKnown ? " (calibration.gain with what calibration.depth_offset_m adds)" : "");
  const Parameter hasDepths = depthsOf(image.depths, count),
                  wantsDepths = depthsOf(depths, config.gauges.count);
  if (hasDepths.value != wantsDepths.value) differences += differenceOf(hasDepths, wantsDepths);
  if (differences.empty()) return;
  throw Failure(ExitCode::kMismatch,
                fmt::format("{}: made for another finger than the config's:{}\nmake it anew with: "
                            "strainfinger tables -c CONFIG -o {}",
                            path, differences, path));
}

std::string imageBytes(const TableImage& image) {
  std::string bytes(sizeof(image), '\0');
  std::memcpy(bytes.data(), &image, sizeof(image));
  return bytes;
}

std::string imageHeader(const TableImage& image) {
  std::string text =
      "#pragma once\n"
      "// Lookup tables of a finger, made by `strainfinger tables --header`. Not to be edited: make them "
      "anew.\n";
  for (const Parameter& parameter : parametersOf(image.parameters))
    fmt::format_to(std::back_inserter(text), "//   {} = {}\n", parameter.key, textOf(parameter));
  for (const Parameter& parameter : {anglesOf(image.gauge_angle_q32, image.constants.gauge_count),
                                     gainsOf(image), depthsOf(image.depths, image.constants.gauge_count)})
    fmt::format_to(std::back_inserter(text), "//   {} = {}\n", parameter.key, textOf(parameter));
  fmt::format_to(std::back_inserter(text),
                 "// CRC-32 0x{:08X}\n\n#include <cstdint>\n\nnamespace strainfinger {{\n\n"
                 "alignas(8) inline constexpr std::uint8_t kDefaultTableBytes[{}] = {{",
                 image.crc32, sizeof(image));
  const std::string bytes = imageBytes(image);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    fmt::format_to(std::back_inserter(text), "{}{},", i % 20 == 0 ? "\n    " : " ",
                   static_cast<unsigned char>(bytes[i]));
  text += "\n};\n\n}  // namespace strainfinger\n";
  return text;
}

}  // namespace strainfinger::tables
