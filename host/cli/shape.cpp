#include "host/shape/shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <variant>
#include <vector>

#include "host/base/angles.hpp"
#include "host/base/no_value.hpp"
#include "host/base/strain_rows.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/config/over_range.hpp"
#include "host/shape/partial_ring.hpp"
#include "host/shape/quantiles.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kShapeHelp =
    "What pressed on the finger, from rows of gauge strains on stdin: as much as they tell, and no "
    "more.\n"
    "stdin: CSV, one strain a gauge in a row, a row a touch; blank lines and # comments are passed "
    "over. In a header row the gauges' columns are strain_0, strain_1 .., in any order; other columns, "
    "such as time_s, are left out. The config's [calibration] says the gain, the angle and the depth of each "
    "gauge. Sigmas include noise, gauges.model_error and the errors in [calibration]. With the default "
    "gauges.model_error = 0.05 little more than place and load can be determined: calibrate the finger "
    "first. The width is always an unknown here, whatever contact.width_m says. Shear is taken to be spread "
    "as "
    "pressure is, while `run` and `locate` have partial slip (Mindlin): with much of it places are "
    "off by more than their sigmas on a perfect finger.\n"
    "stdout: one row a touch; what isn't known is empty\n"
    "  contact                1 or 0\n"
    "  angle_deg, normal_n_per_m, tangential_n_per_m\n"
    "                         place and loads\n"
    "  width_m                of the semi-ellipse with the load's second moment, if no line load fits\n"
    "                         (3 sigma)\n"
    "  curvature_per_m        of a round indenter that makes this width under this load; 0: flat\n"
    "  sigma_angle_deg, sigma_normal_n_per_m, sigma_tangential_n_per_m, sigma_width_m,\n"
    "  sigma_curvature_per_m  standard errors of these\n"
    "  width_limit_m          the width is below this with a probability of 95 %\n"
    "  directions             of the pressure, as many as are above the noise\n"
    "  class                  round, uniform, wedge or punch, if it fits better than the others by 9 in\n"
    "                         chi-squared\n"
    "  unresolved             which of width, class and odd-part the strains don't determine\n"
    "  fit_probability        of residuals that are as large or larger by noise alone\n"
    "  rival_angle_deg        of another touch that fits about as well; angle_deg again, if only width or\n"
    "                         loads differ\n"
    "  warnings               joined by +\n"
    "    saturated            gauges within 5 % of the end of the converter's range, or beyond, were left\n"
    "                         out; of more than half of them, all else is empty\n"
    "    ambiguous            a rival fits about as well: the bands of 95 % include it, and no class is "
    "named\n"
    "    sparse               gauges are more than twice their depth apart at the surface: no width, and\n"
    "                         errors may exceed the sigmas\n"
    "    misfit               residuals are not noise: two touches, a bad gauge, another noise_strain\n"
    "    profile              another class fits too, and has a value outside its band of 95 %\n"
    "    wide                 wider than 1 rad, or narrower than a line\n"
    "  curvature_low_per_m, curvature_high_per_m\n"
    "                         band of 95 % of the curvature; no upper end where empty\n"
    "With --pressure instead: prints sample,angle_deg,pressure_pa,low_pa,high_pa,ellipse_pa, --points rows a "
    "touch: the number of its row on stdin from 1, the resolved part of the pressure with its band of "
    "95 %, and the ellipse fitted.";

struct ShapeOptions {
  explicit ShapeOptions(CLI::App& command) : common(command) {
    hasNoise = command
                   .add_option("--noise-strain", noise_strain,
                               "Standard deviation of a reading; the config's without it")
                   ->type_name("S")
                   ->check(isFrom(1e-12, 0.1));
    auto* const withPressure =
        command.add_flag("--pressure", pressure, "The pressure against the angle in place of the summary");
    command.add_option("--points", points, fmt::format("Angles that --pressure prints a touch ({})", points))
        ->needs(withPressure)
        ->type_name("N")
        ->check(isWhole(2, 100'000));
  }
  config::FingerConfig config() const {
    config::FingerConfig config = common.config();
    if (hasNoise->count() > 0) config.gauges.noise_strain = noise_strain;
    return config;
  }
  CommonOptions common;
  CLI::Option* hasNoise;
  double noise_strain = 0;
  bool pressure = false;
  int points = 41;
};

std::string unresolved(const shape::Shape& shape) {
  std::vector<std::string> words;
  if (!shape.width_m) words.emplace_back("width");
  if (!shape.profile) words.emplace_back("class");
  if (!shape.isOddResolved) words.emplace_back("odd-part");
  return fmt::format("{}", fmt::join(words, " "));
}

constexpr const char* kClipped = "saturated";

std::string warnings(const shape::Shape& shape, bool isClipped) {
  std::vector<std::string> words;
  if (isClipped) words.emplace_back(kClipped);
  if (shape.rivalAngle_rad) words.emplace_back("ambiguous");
  if (shape.isSparse) words.emplace_back("sparse");
  if (shape.fitProbability < shape::kUnlikely) words.emplace_back("misfit");
  if (shape.isOfEllipse) words.emplace_back("profile");
  if (shape.isWidthAtLimit) words.emplace_back("wide");
  return fmt::format("{}", fmt::join(words, " "));
}

NamedRow shapeRow(const shape::Shape& shape, bool isClipped) {
  const shape::Measured unknown{kNoValue, kNoValue};
  const shape::Measured width = shape.width_m.value_or(unknown);
  const shape::Measured curvature = shape.curvature_per_m.value_or(unknown);
  const shape::Band band = shape.curvatureBand_per_m.value_or(shape::Band{kNoValue, kNoValue});
  return {{"contact", std::int64_t{1}},
          {"angle_deg", degreesOf(shape.angle_rad.value)},
          {"normal_n_per_m", shape.normal_n_per_m.value},
          {"tangential_n_per_m", shape.tangential_n_per_m.value},
          {"width_m", width.value},
          {"curvature_per_m", curvature.value},
          {"sigma_angle_deg", shape.angle_rad.sigma / kRadPerDeg},
          {"sigma_normal_n_per_m", shape.normal_n_per_m.sigma},
          {"sigma_tangential_n_per_m", shape.tangential_n_per_m.sigma},
          {"sigma_width_m", width.sigma},
          {"sigma_curvature_per_m", curvature.sigma},
          {"width_limit_m", shape.widthLimit_m},
          {"directions", std::int64_t{shape.directions}},
          {"class", std::string(shape.profile ? nameOf(*shape.profile) : "")},
          {"unresolved", unresolved(shape)},
          {"fit_probability", shape.fitProbability},
          {"rival_angle_deg", shape.rivalAngle_rad ? degreesOf(*shape.rivalAngle_rad) : kNoValue},
          {"warnings", warnings(shape, isClipped)},
          {"curvature_low_per_m", band.low},
          {"curvature_high_per_m", std::isfinite(band.high) ? band.high : kNoValue}};
}

/// A row of which only these are known: of the others numbers are missing and texts empty.
NamedRow unknownTouch(std::int64_t contact, const std::string& warning) {
  NamedRow row = shapeRow({}, false);
  for (auto& [column, value] : row) {
    if (column == "contact")
      value = contact;
    else if (column == "warnings")
      value = warning;
    else if (std::holds_alternative<std::string>(value))
      value = std::string();
    else
      value = kNoValue;
  }
  return row;
}

/// One row of strains.
struct Reading {
  std::int64_t sample;      ///< from 1
  std::vector<int> gauges;  ///< within their range
  Eigen::VectorXd strains;  ///< of these gauges, over their gains
  double largest_strain;    ///< of all gauges, either sign, over its gain

  bool isClipped(const config::FingerConfig& config) const {
    return static_cast<int>(gauges.size()) < config.gauges.count;
  }
  /// More than half of the gauges at the end of their range: the rest tells no touch.
  bool isTooFew(const config::FingerConfig& config) const {
    return 2 * static_cast<int>(gauges.size()) < config.gauges.count;
  }
};

Reading readingOf(const config::FingerConfig& config, const std::vector<double>& row, std::int64_t sample) {
  Reading reading{sample, {}, {}, 0};
  for (int i = 0; i < config.gauges.count; ++i) {
    const double strain = row[static_cast<std::size_t>(i)];
    reading.largest_strain = std::max(reading.largest_strain, std::abs(strain) / config.calibrated(i).gain);
    if (!config::isOverRange(config.gauges, strain)) reading.gauges.push_back(i);
  }
  reading.strains.resize(static_cast<Eigen::Index>(reading.gauges.size()));
  for (std::size_t k = 0; k < reading.gauges.size(); ++k)
    reading.strains[static_cast<Eigen::Index>(k)] =
        row[static_cast<std::size_t>(reading.gauges[k])] / config.calibrated(reading.gauges[k]).gain;
  return reading;
}

template <typename Print>
void forEachReading(const config::FingerConfig& config, Print print) {
  NumberRowReader rows(std::cin, "stdin", static_cast<std::size_t>(config.gauges.count),
                       strainLimit(config.gauges.count));
  std::int64_t sample = 0;
  for (std::vector<double> row; rows.next(row);) print(readingOf(config, row, ++sample));
}

void printShapes(const ShapeOptions& options, const config::FingerConfig& config) {
  shape::RingEstimators estimators(config);  // before anything is printed
  TableWriter table(stdout, options.common.format(), columnsOf(shapeRow({}, false)));
  forEachReading(config, [&](const Reading& reading) {
    if (reading.isTooFew(config)) return table.row(valuesOf(unknownTouch(1, kClipped)));
    const auto shape = estimators.by(reading.gauges).estimate(reading.strains, reading.largest_strain);
    const bool isClipped = reading.isClipped(config);
    table.row(valuesOf(shape       ? shapeRow(*shape, isClipped)
                       : isClipped ? unknownTouch(1, kClipped)
                                   : unknownTouch(0, "")));
  });
}

void printPressures(const ShapeOptions& options, const config::FingerConfig& config) {
  shape::RingEstimators estimators(config);  // before anything is printed
  TableWriter table(stdout, options.common.format(),
                    {"sample", "angle_deg", "pressure_pa", "low_pa", "high_pa", "ellipse_pa"});
  forEachReading(config, [&](const Reading& reading) {
    if (reading.isTooFew(config)) return;
    const shape::ShapeEstimator& estimator = estimators.by(reading.gauges);
    const auto shape = estimator.estimate(reading.strains, reading.largest_strain);
    if (!shape) return;
    const double half_rad = estimator.pressedHalf_rad(*shape);
    const auto offsets_rad = Eigen::VectorXd::LinSpaced(options.points, -half_rad, half_rad);
    const auto pressure = estimator.pressure(*shape, reading.strains, offsets_rad);
    const double mean_pa = shape->normal_n_per_m.value / estimator.model().outerRadius_m();
    for (Eigen::Index i = 0; i < offsets_rad.size(); ++i) {
      const double band_pa = shape::kTwoSided95 * pressure.sigma_pa[i], value_pa = pressure.pressure_pa[i];
      const double ellipse_pa =
          mean_pa * density(model::Profile::kEllipse, model::momentOfWidth(2 * half_rad), offsets_rad[i]);
      table.row({reading.sample, degreesOf(shape->angle_rad.value + offsets_rad[i]), value_pa,
                 value_pa - band_pa, value_pa + band_pa, ellipse_pa});
    }
  });
}

void runShape(const ShapeOptions& options) {
  const config::FingerConfig config = options.config();
  if (options.pressure)
    printPressures(options, config);
  else
    printShapes(options, config);
}

}  // namespace

void addShape(CLI::App& app) { addCommand<ShapeOptions>(app, "shape", kShapeHelp, runShape); }

}  // namespace strainfinger::cli
