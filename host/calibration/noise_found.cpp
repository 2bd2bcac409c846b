#include "host/calibration/noise_found.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "host/base/chi_squared.hpp"
#include "host/base/quantile.hpp"
#include "host/calibration/findings.hpp"
#include "host/calibration/model_error.hpp"

namespace strainfinger::calibration {
namespace {

/// [1] Of the noise, either way. Sigmas that are off by less mislead nobody, and whoever measures noise on a
/// bench hardly does it better.
constexpr double kOtherNoise = 1.25;
/// [pairs of rows] Fewer tell only noise that is off by more than a factor of 1.7.
constexpr std::size_t kLeastRowsOfNoise = 3;

/// Sums of squares over the config's variance, of rows with so many degrees of freedom each.
struct Scatter {
  std::vector<double> chiSquareds;
  double freedom = 1;
  double roundingShare = 0;  ///< [1] Relative standard deviation of the mean variance besides chance
};

/// Half the squared differences of untouched rows that follow each other: zeros that drift or that are off
/// are none of them.
Scatter scatterOfUntouched(const CalibrationResult& result) {
  const config::Gauges& gauges = result.drawing().config().gauges;
  Scatter scatter{{}, static_cast<double>(gauges.count), 0};
  const auto& rows = result.rows();
  const auto isUntouched = [&](const RowResult& row) {
    return row.use == RowUse::kUntouched || isDriftedZero(result, row);
  };
  for (std::size_t row = 0; row + 1 < rows.size(); ++row) {
    if (!isUntouched(rows[row]) || !isUntouched(rows[row + 1])) continue;
    const double squares = (rows[row + 1].residual_strain - rows[row].residual_strain).squaredNorm() / 2;
    scatter.chiSquareds.push_back(squares / std::pow(gauges.noise_strain, 2));
    ++row;  // no row is in two pairs: they are independent
  }
  // A gauge that nothing touches stays at one code of the converter or between two: the variance of its
  // rounding is anything between 0 and 3 times that of the config's noise_strain, with a standard deviation
  // of 0.9 times that.
  scatter.roundingShare = std::pow(gauges.quantisation_strain() / gauges.noise_strain, 2) /
                          std::sqrt(static_cast<double>(gauges.count));
  return scatter;
}

/// Touches read all codes: what rounding adds is as the config has it.
Scatter scatterOfTouches(const CalibrationResult& result) {
  const Drawing& drawing = result.drawing();
  const auto fitted = static_cast<double>(result.count(RowUse::kFitted));
  const double each = static_cast<double>(drawing.unknowns()) / std::max(fitted, 1.0);
  Scatter scatter{{}, std::max(1.0, drawing.gauges() - kTouchUnknowns - each), 0};
  for (const RowResult& row : result.rows())
    if (row.use == RowUse::kFitted)
      scatter.chiSquareds.push_back(row.residual_strain.squaredNorm() /
                                    std::pow(drawing.config().gauges.noise_strain, 2));
  return scatter;
}

/// Of a normal variance that is estimated as well as this one: the median costs pi / 2, and rounding adds.
double freedomOf(const Scatter& scatter) {
  const double all = scatter.freedom * static_cast<double>(scatter.chiSquareds.size());
  return 2 / (std::numbers::pi / all + std::pow(scatter.roundingShare, 2));
}

/// The noise over the config's, if it is off by so much on that side (1: noisier, -1: quieter). By the
/// median, as single rows may be no rest or no touch.
std::optional<NoiseFound> foundIn(const Scatter& scatter, int side) {
  if (scatter.chiSquareds.size() < kLeastRowsOfNoise) return std::nullopt;
  const double variance = medianOf(scatter.chiSquareds) / chiSquaredQuantile(scatter.freedom, 0);
  const double freedom = freedomOf(scatter);
  const double byChance = chiSquaredQuantile(freedom, side * kBeyondChance) / freedom;
  const double ratio = std::sqrt(variance);
  const bool isFound = side > 0 ? ratio >= kOtherNoise && variance > byChance
                                : ratio <= 1 / kOtherNoise && variance < byChance;
  return isFound ? std::optional(NoiseFound{ratio}) : std::nullopt;
}

}  // namespace

std::optional<NoiseFound> noiseFound(const CalibrationResult& result) {
  const auto noisier = foundIn(scatterOfUntouched(result), 1);
  return noisier ? noisier : foundIn(scatterOfTouches(result), -1);
}

std::string noiseText(const CalibrationResult& result) {
  const auto found = noiseFound(result);
  if (!found) return {};
  return fmt::format(
      "{} {:.2g} times {} than gauges.noise_strain = {}: check gauges.full_scale_strain and the amplifier's "
      "gain (if one is wrong, all strains are wrong by that factor), then gauges.noise_strain",
      found->isNoisier() ? "Readings of untouched rows are" : "Residuals of touches are",
      found->isNoisier() ? found->ratio : 1 / found->ratio, found->isNoisier() ? "noisier" : "quieter",
      result.drawing().config().gauges.noise_strain);
}

}  // namespace strainfinger::calibration
