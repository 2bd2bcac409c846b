#include "host/tables/table_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <variant>

#include "common/fixed_real.hpp"
#include "host/base/failure.hpp"
#include "host/config/keys.hpp"
#include "host/tables/gauge_gains.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger::tables {
namespace {

/// To so many digits, as people read it.
double rounded(double value, int digits) { return std::stod(fmt::format("{:.{}g}", value, digits)); }

std::vector<Parameter> numbersOf(const TableParameters& p) {
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

Parameter anglesOf(const TableImage& image) {
  std::vector<double> angles_deg;
  for (std::size_t i = 0; i < image.constants.gauge_count; ++i)
    angles_deg.push_back(rounded(360 * toReal(TurnQ32::fromRaw(image.gauge_angle_q32[i])), 6));
  return {"gauges.angle_deg", angles_deg};
}

Parameter gainsOf(const TableImage& image, bool areDepthsKnown) {
  std::vector<double> known;
  if (image.gains.areKnown())
    for (const double factor : correctionFactors(image.gains, image.constants.gauge_count))
      known.push_back(rounded(1 / factor, 4));
  return {areDepthsKnown ? "gain_with_depth" : "calibration.gain", known};
}

Parameter depthsOf(const TableImage& image) {
  std::vector<double> offsets_m;
  if (image.depths.areKnown())
    for (std::size_t i = 0; i < image.constants.gauge_count; ++i)
      offsets_m.push_back(rounded(1e-9 * image.depths.steps[i] * image.depths.step_nm, 3));
  return {"calibration.depth_offset_m", offsets_m};
}

std::string differenceOf(const Parameter& has, const Parameter& wants) {
  return fmt::format("\n  {} is {}, the config has {}", has.key, textOf(has), textOf(wants));
}

/// Angles that differ because the ring begins elsewhere or has other gauges are told by those parameters.
bool isSameRing(const TableParameters& a, const TableParameters& b) {
  return a.gauge_count == b.gauge_count && a.first_angle_deg == b.first_angle_deg;
}

std::string differencesOf(const TableImage& image, const TableImage& wanted) {
  std::string differences;
  const auto add = [&](const Parameter& has, const Parameter& wants) {
    if (has.value != wants.value) differences += differenceOf(has, wants);
  };
  const auto has = numbersOf(image.parameters), wants = numbersOf(wanted.parameters);
  for (std::size_t i = 0; i < has.size(); ++i) add(has[i], wants[i]);
  if (isSameRing(image.parameters, wanted.parameters) && image.gauge_angle_q32 != wanted.gauge_angle_q32)
    differences += differenceOf(anglesOf(image), anglesOf(wanted));
  const bool areDepthsKnown = image.depths.areKnown() || wanted.depths.areKnown();
  if (image.gains != wanted.gains)
    differences += differenceOf(gainsOf(image, areDepthsKnown), gainsOf(wanted, areDepthsKnown)) +
                   (areDepthsKnown ? " (calibration.gain with what calibration.depth_offset_m adds)" : "");
  add(depthsOf(image), depthsOf(wanted));
  const TableConstants &of = image.constants, &to = wanted.constants;
  const bool haveSameErrors =
      of.model_error_q16 == to.model_error_q16 && of.place_error_q32 == to.place_error_q32 &&
      of.load_scale_error_q16 == to.load_scale_error_q16 && of.moment_error_q16 == to.moment_error_q16;
  if (differences.empty() && !haveSameErrors)
    differences =
        "\n  its standard errors are those of another [tolerance] (depth_m, core_radius_m, poisson_ratio)";
  return differences;
}

}  // namespace

std::vector<Parameter> parametersOf(const TableImage& image) {
  std::vector<Parameter> parameters = numbersOf(image.parameters);
  parameters.insert(parameters.end(),
                    {anglesOf(image), gainsOf(image, image.depths.areKnown()), depthsOf(image)});
  return parameters;
}

std::string textOf(const Parameter& parameter) {
  if (!parameter.value) return kUnknownParameter;
  return std::visit([](const auto& content) { return fmt::format("{}", content); }, *parameter.value);
}

void requireTablesOf(const TableImage& image, const config::FingerConfig& config, const std::string& path) {
  const std::string differences = differencesOf(image, buildTableImage(config));
  if (differences.empty()) return;
  throw Failure(ExitCode::kMismatch,
                fmt::format("{}: made for another finger than the config's:{}\nmake it anew with: "
                            "strainfinger tables -c CONFIG -o {}",
                            path, differences, path));
}

}  // namespace strainfinger::tables
