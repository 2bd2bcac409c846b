#include "host/simulation/touch_errors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/base/angles.hpp"

namespace strainfinger::simulation {
namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;

}  // namespace

TouchError errorOf(const can::TouchReport& report, const Touch& truth, const config::Finger& finger) {
  const double radius_m = finger.outer_radius_m, length_m = finger.length_m;
  const double angle_rad = std::remainder(report.angle_deg * kRadPerDeg - truth.angle_rad, kTurn_rad);
  return {.arc_m = angle_rad * radius_m,
          .normal_n_per_m = report.normal_n / length_m - truth.normal_n_per_m,
          .tangential_n_per_m = report.tangential_n / length_m - truth.tangential_n_per_m,
          .sigmaArc_m = report.sigmaAngle_deg * kRadPerDeg * radius_m,
          .sigmaNormal_n_per_m = report.sigmaNormal_n / length_m,
          .sigmaTangential_n_per_m = report.sigmaTangential_n / length_m};
}

void Deviation::add(double value) {
  ++count_;
  squares_ += value * value;
  worst_ = std::max(worst_, std::fabs(value));
}

double Deviation::rms() const { return std::sqrt(squares_ / static_cast<double>(count_)); }

double Deviation::worst() const { return count_ > 0 ? worst_ : kNoValue; }

void TouchErrors::add(const Moment& moment, const config::Finger& finger) {
  if (moment.compared) {
    add(*moment.compared, finger);
    isTold_ = moment.compared->report.flags.has(FingerFlag::kContact);
  }
  if (!moment.truth.empty() && !isTold_) untold_s += SimulatedGauges::kSamplePeriod_us * 1e-6;
}

void TouchErrors::add(const ComparedTouch& compared, const config::Finger& finger) {
  const FingerFlags flags = compared.report.flags;
  if (!flags.has(FingerFlag::kContact)) {
    if (!compared.truth.empty()) ++missed;
  } else if (compared.truth.empty()) {
    ++phantom;
  } else if (compared.truth.size() > 1) {
    ++several;
  } else if (flags.has(FingerFlag::kUncertain)) {
    ++uncertain;
  } else {
    const TouchError error = errorOf(compared.report, compared.truth.front(), finger);
    arc_m.add(error.arc_m);
    normal_n_per_m.add(error.normal_n_per_m);
    tangential_n_per_m.add(error.tangential_n_per_m);
  }
}

}  // namespace strainfinger::simulation
