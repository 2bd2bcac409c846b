#include "host/cli/touch_recorder.hpp"

#include <cmath>
#include <numbers>

#include "common/fixed_real.hpp"
#include "host/base/angles.hpp"

namespace strainfinger::cli {
namespace {

using simulation::Touch;

constexpr int kProfileSteps = 720;

plot::ContactPoint truthPoint(const std::vector<Touch>& truth) {
  if (truth.size() != 1) return {};
  const Touch& touch = truth.front();
  return {touch.angle_rad / kRadPerDeg, touch.normal_n_per_m, touch.tangential_n_per_m};
}

}  // namespace

void TouchRecorder::add(const simulation::Moment& moment, const firmware::Readings& readings) {
  addToTrack(moment);
  const auto& compared = moment.compared;
  if (!compared || compared->truth.size() != 1 || compared->time_s != moment.time_s) return;
  const Touch& touch = compared->truth.front();
  const double load_n_per_m = std::hypot(touch.normal_n_per_m, touch.tangential_n_per_m);
  if (load_n_per_m <= hardest_n_per_m_) return;
  hardest_n_per_m_ = load_n_per_m;
  hardest_ = *compared;
  readings_ = readings;
}

/// The first report of a period, if there is one, takes the place of the period's plain truth.
void TouchRecorder::addToTrack(const simulation::Moment& moment) {
  if (track_.empty() || moment.time_s >= periodEnd_s_) {
    periodEnd_s_ = moment.time_s + kTrackPeriod_s;
    track_.push_back({.time_s = moment.time_s,
                      .truth = truthPoint(moment.truth),
                      .estimate = {},
                      .areSeveral = moment.truth.size() > 1});
  }
  const auto& compared = moment.compared;
  if (!compared || !compared->report.flags.has(FingerFlag::kContact)) return;
  if (!std::isnan(track_.back().estimate.angle_deg)) return;
  track_.back() = {compared->time_s, truthPoint(compared->truth), pointOf(compared->report),
                   compared->report.sigmaAngle_deg, compared->truth.size() > 1};
}

plot::ContactPoint TouchRecorder::pointOf(const can::TouchReport& report) const {
  const double length_m = told_.finger.length_m;
  return {report.angle_deg, report.normal_n / length_m, report.tangential_n / length_m};
}

plot::TouchRecord TouchRecorder::record(const simulation::GaugeStrains& strains) const {
  plot::TouchRecord record{.moment_s = hardest_.time_s,
                           .truthThen = truthPoint(hardest_.truth),
                           .estimateThen = pointOf(hardest_.report),
                           .profile = {},
                           .readings = {},
                           .track = track_,
                           .outerRadius_m = told_.finger.outer_radius_m};
  for (int step = 0; step <= kProfileSteps; ++step) {
    const double angle_rad = 2 * std::numbers::pi * step / kProfileSteps;
    record.profile.push_back(
        {angle_rad / kRadPerDeg, strains.at(angle_rad, hardest_.truth), fit_.at(angle_rad, hardest_.report)});
  }
  const std::vector<double> fitted = fit_.readings(hardest_.report);
  for (int gauge = 0; gauge < strains.count(); ++gauge) {
    const auto i = static_cast<std::size_t>(gauge);
    record.readings.push_back({strains.gaugeAngle_rad(gauge) / kRadPerDeg,
                               toReal(StrainQ32::fromRaw(readings_.strain_q32[i])), fitted[i] * factors_[i],
                               told_.gauges.noise_strain});
  }
  return record;
}

}  // namespace strainfinger::cli
