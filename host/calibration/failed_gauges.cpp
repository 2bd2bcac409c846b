#include "host/calibration/failed_gauges.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "host/config/over_range.hpp"

namespace strainfinger::calibration {
namespace {

using Eigen::ArrayXd, Eigen::Index, Eigen::MatrixXd;
using FailedKind = FailedGauge::Kind;

/// [rows] Of fewer, a gauge that is hardly touched may give one code of the converter by chance.
constexpr Index kLeastRows = 20;
/// [noise] RMS about the mean over all rows: with less a gauge shows noise alone; a gauge that is touched has
/// hundreds. Where one beside it has less than kLoud, it may be that nothing touched either.
constexpr double kQuiet = 2, kLoud = 20;
/// [gauges] To either side, where a gauge that reads touches is looked for: two that fail side by side are
/// told; more that are quiet are an arc that wasn't touched.
constexpr int kBeside = 2;
/// Of all rows. A touch can take the gauge below it over range, but no gauge is below half of the touches of
/// a ring.
constexpr double kMostOverRange = 0.5;

double scatter_strain(const MatrixXd& readings, Index gauge) {
  const ArrayXd column = readings.col(gauge);
  return std::sqrt((column - column.mean()).square().mean());
}

std::optional<FailedGauge> atEnd(const config::Gauges& gauges, const MatrixXd& readings, int gauge) {
  const ArrayXd column = readings.col(gauge);
  double sum = 0;
  Index rows = 0;
  for (const double strain : column) {
    if (!config::isOverRange(gauges, strain)) continue;
    sum += strain;
    ++rows;
  }
  if (static_cast<double>(rows) < kMostOverRange * static_cast<double>(column.size())) return std::nullopt;
  return FailedGauge{FailedKind::kAtEnd, gauge, sum / static_cast<double>(rows), rows};
}

/// Whether a gauge near this one, on that side (1 or -1), reads touches.
bool isLoudBeside(const ArrayXd& scatter, double least, int gauge, int side) {
  const int count = static_cast<int>(scatter.size());
  for (int away = 1; away <= kBeside; ++away)
    if (scatter[(gauge + side * away + count) % count] > least) return true;
  return false;
}

}  // namespace

std::vector<FailedGauge> findFailedGauges(const config::Gauges& gauges, const MatrixXd& readings) {
  std::vector<FailedGauge> failed;
  if (readings.rows() < kLeastRows) return failed;
  ArrayXd scatter(readings.cols());
  for (Index gauge = 0; gauge < readings.cols(); ++gauge) scatter[gauge] = scatter_strain(readings, gauge);
  const double loud = kLoud * gauges.noise_strain;
  for (int gauge = 0; gauge < gauges.count; ++gauge) {
    const ArrayXd column = readings.col(gauge);
    const FailedGauge still{FailedKind::kConstant, gauge, column.mean(), column.size()};
    const bool isTouchedAround =
        isLoudBeside(scatter, loud, gauge, 1) && isLoudBeside(scatter, loud, gauge, -1);
    if (const auto end = atEnd(gauges, readings, gauge))
      failed.push_back(*end);
    else if (isTouchedAround && column.maxCoeff() == column.minCoeff())
      failed.push_back(still);
    else if (isTouchedAround && scatter[gauge] < kQuiet * gauges.noise_strain)
      failed.push_back({FailedKind::kNoise, gauge, still.strain, still.rows});
  }
  const bool isAll = failed.size() == static_cast<std::size_t>(gauges.count);
  return isAll ? std::vector<FailedGauge>() : failed;
}

std::string textOf(const FailedGauge& failed) {
  const double whole_microstrain = std::round(1e6 * failed.strain) + 0.0;  // which makes a -0 a 0
  const std::string reads = fmt::format("gauge {} reads {:.0f} microstrain", failed.gauge, whole_microstrain);
  if (failed.kind == FailedKind::kAtEnd)
    return fmt::format(
        "{}, the end of its range, in {} rows: look at its bridge and its amplifier, and for an open wire; "
        "where it was pressed in all of them, press less",
        reads, failed.rows);
  return fmt::format("{} in all {} rows{}: it is dead or not connected: look for an open wire or joint",
                     reads, failed.rows, failed.kind == FailedKind::kNoise ? ", but for noise" : "");
}

}  // namespace strainfinger::calibration
