#include "host/calibration/row.hpp"

#include <algorithm>
#include <cmath>

#include "host/base/angles.hpp"
#include "host/config/over_range.hpp"
#include "host/model/pressure_profile.hpp"

namespace strainfinger::calibration {
namespace {

/// A touch whose largest reading is less than this part of what strong touches read tells nothing beside
/// them, as one below kWeakestTouch tells nothing beside noise.
constexpr double kWeakestOfStrong = 0.125, kStrong = 0.9;
/// Widths are unknown, but not without end: the prior's standard deviation over the largest moment.
constexpr double kMomentSpread = 10;
/// Standard deviation of a known untouched finger's loads [N/m] and of a known width's moment [rad^2].
constexpr double kExactly = 1e-6;

void know(TouchPrior& prior, TouchUnknown unknown, double value, double sigma) {
  prior.value[unknown] = value;
  prior.weight[unknown] = 1 / sigma;
}

TouchPrior priorOf(const config::FingerConfig& config, const KnownTouch& touch, const KnownErrors& errors) {
  TouchPrior prior = priorOfAny(config);
  if (touch.isUntouched()) {
    know(prior, kPlace, 0, 1);
    know(prior, kNormalLoad, 0, kExactly);
    know(prior, kTangentialLoad, 0, kExactly);
    return prior;
  }
  const double load_n_per_m = touch.normal_n_per_m.value_or(touch.tangential_n_per_m.value_or(0));
  const double sigma_n_per_m = std::max(kExactly, errors.load * std::abs(load_n_per_m));
  if (touch.angle_deg)
    know(prior, kPlace, *touch.angle_deg * kRadPerDeg, std::max(kExactly, errors.angle_deg * kRadPerDeg));
  if (touch.normal_n_per_m) know(prior, kNormalLoad, *touch.normal_n_per_m, sigma_n_per_m);
  if (touch.tangential_n_per_m) know(prior, kTangentialLoad, *touch.tangential_n_per_m, sigma_n_per_m);
  return prior;
}

RowUse useOf(const Row& row, const config::Gauges& gauges) {
  if (config::isOverRange(gauges, row.peak_strain())) return RowUse::kOverRange;
  if (row.known.isUntouched()) return RowUse::kUntouched;
  return row.peak_strain() < kWeakestTouch * gauges.noise_strain ? RowUse::kWeak : RowUse::kFitted;
}

void leaveOutWeak(std::vector<Row>& rows) {
  std::vector<double> peaks;
  for (const Row& row : rows)
    if (row.isUsable()) peaks.push_back(row.peak_strain());
  if (peaks.empty()) return;
  const auto strong =
      peaks.begin() + static_cast<std::ptrdiff_t>(kStrong * static_cast<double>(peaks.size()));
  std::nth_element(peaks.begin(), strong, peaks.end());
  for (Row& row : rows)
    if (row.isFitted() && !row.isKnown() && row.peak_strain() < kWeakestOfStrong * *strong)
      row.result.use = RowUse::kWeak;
}

}  // namespace

TouchPrior priorOfAny(const config::FingerConfig& config) {
  const double radius_m = config.finger.outer_radius_m;
  TouchPrior prior;
  if (const auto width_m = config.contact.width_m)
    know(prior, kMoment, model::momentOf(model::Profile::kUniform, *width_m / radius_m), kExactly);
  else
    know(prior, kMoment, 0, kMomentSpread * model::momentOfWidth(config.contact.largest_width_m / radius_m));
  return prior;
}

std::vector<Row> rowsOf(const config::FingerConfig& config, std::span<const KnownTouch> known,
                        const Eigen::MatrixXd& readings, const KnownErrors& errors) {
  std::vector<Row> rows(static_cast<std::size_t>(readings.rows()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Row& row = rows[i];
    if (!known.empty()) row.known = known[i];
    row.data = {readings.row(static_cast<Eigen::Index>(i)), config.gauges.noise_strain,
                priorOf(config, row.known, errors)};
    row.data.readings.cwiseAbs().maxCoeff(&row.result.peakGauge);
    row.result.use = useOf(row, config.gauges);
  }
  leaveOutWeak(rows);
  return rows;
}

}  // namespace strainfinger::calibration
