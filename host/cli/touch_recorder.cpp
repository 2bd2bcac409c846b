#include "host/cli/touch_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/fixed_real.hpp"
#include "host/base/angles.hpp"
#include "host/simulation/touch_errors.hpp"

namespace strainfinger::cli {
namespace {

using simulation::Touch;

constexpr int kProfileSteps = 720;

plot::ContactPoint pointOf(const Touch& touch) {
  return {touch.angle_rad / kRadPerDeg, touch.normal_n_per_m, touch.tangential_n_per_m};
}

plot::ContactPoint pointOf(const can::ContactReport& contact, double length_m) {
  return {contact.angle_deg, contact.normal_n / length_m, contact.tangential_n / length_m};
}

std::vector<plot::TrackedContact> contactsOf(const std::vector<Touch>& truth, const can::TouchReport& report,
                                             double length_m) {
  std::vector<plot::TrackedContact> tracked;
  for (const auto& [touch, contact] : simulation::toldTouches(truth, report)) {
    tracked.emplace_back();
    if (touch) tracked.back().truth = pointOf(*touch);
    if (!contact) continue;
    tracked.back().estimate = pointOf(*contact, length_m);
    tracked.back().sigmaAngle_deg = contact->sigmaAngle_deg;
    tracked.back().isFlagged = report.flags.has(FingerFlag::kUncertain);
  }
  return tracked;
}

}  // namespace

void TouchRecorder::add(const simulation::Moment& moment, const firmware::Readings& readings) {
  addToTrack(moment);
  const auto& compared = moment.compared;
  if (!compared || compared->truth.empty() || compared->time_s != moment.time_s) return;
  const Worth worth = worthOf(*compared);
  if (worth <= worth_) return;
  worth_ = worth;
  shown_ = *compared;
  readings_ = readings;
}

TouchRecorder::Worth TouchRecorder::worthOf(const simulation::ComparedTouch& compared) {
  double load_n_per_m = 0;
  for (const Touch& touch : compared.truth)
    load_n_per_m += std::hypot(touch.normal_n_per_m, touch.tangential_n_per_m);
  const auto told = simulation::toldTouches(compared.truth, compared.report);
  return {-std::ranges::count_if(told, [](const auto& each) { return !each.isWhole(); }), load_n_per_m};
}

/// The first report of a period, if there is one, takes the place of the period's plain truth.
void TouchRecorder::addToTrack(const simulation::Moment& moment) {
  const double length_m = told_.finger.length_m;
  if (track_.empty() || moment.time_s >= periodEnd_s_) {
    periodEnd_s_ = moment.time_s + kTrackPeriod_s;
    isTold_ = false;
    track_.push_back({moment.time_s, contactsOf(moment.truth, {}, length_m)});
  }
  const auto& compared = moment.compared;
  if (isTold_ || !compared || !compared->report.flags.has(FingerFlag::kContact)) return;
  isTold_ = true;
  track_.back() = {compared->time_s, contactsOf(compared->truth, compared->report, length_m)};
}

plot::TouchRecord TouchRecorder::record(const simulation::GaugeStrains& strains) const {
  plot::TouchRecord record{.moment_s = shown_.time_s,
                           .contacts = contactsOf(shown_.truth, shown_.report, told_.finger.length_m),
                           .profile = {},
                           .readings = {},
                           .track = track_,
                           .outerRadius_m = told_.finger.outer_radius_m};
  for (int step = 0; step <= kProfileSteps; ++step) {
    const double angle_rad = 2 * std::numbers::pi * step / kProfileSteps;
    record.profile.push_back(
        {angle_rad / kRadPerDeg, strains.at(angle_rad, shown_.truth), fit_.at(angle_rad, shown_.report)});
  }
  const std::vector<double> fitted = fit_.readings(shown_.report);
  for (int gauge = 0; gauge < strains.count(); ++gauge) {
    const auto i = static_cast<std::size_t>(gauge);
    record.readings.push_back({strains.gaugeAngle_rad(gauge) / kRadPerDeg,
                               toReal(StrainQ32::fromRaw(readings_.strain_q32[i])), fitted[i] * factors_[i],
                               told_.gauges.noise_strain});
  }
  return record;
}

}  // namespace strainfinger::cli
