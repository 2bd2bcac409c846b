#include <algorithm>
#include <cmath>

#include "host/base/angles.hpp"
#include "host/calibration/calibrate.hpp"
#include "host/calibration/expected_error.hpp"
#include "host/config/keys.hpp"

namespace strainfinger::calibration {
namespace {

/// A value to so many digits behind the point: what is beyond is noise, and hard to read.
double toDigits(double value, int digits) {
  const double scale = std::pow(10.0, digits);
  return std::round(value * scale) / scale;
}

/// [deg] Of an angle, behind the point.
constexpr int kAngleDigits = 5;

/// The same gauges, all of them further on.
void turn(config::Gauges& gauges, double turn_deg) {
  const auto turned = [turn_deg](double angle_deg) {
    return withinATurn_deg(toDigits(angle_deg + turn_deg, kAngleDigits));
  };
  if (gauges.isEven()) gauges.first_angle_deg = turned(gauges.first_angle_deg);
  for (double& angle_deg : gauges.angles_deg) angle_deg = turned(angle_deg);
}

}  // namespace

Estimate CalibrationResult::of(int gauge, GaugeUnknown unknown, double drawn) const {
  const Eigen::Index at = Drawing::at(gauge, unknown);
  const double unit = drawing_.tolerance(unknown);
  return {drawn + unit * deviations_[at], unit * std::sqrt(covariance_(at, at))};
}

Estimate CalibrationResult::of(RubberUnknown unknown, double drawn) const {
  const Eigen::Index at = drawing_.at(unknown);
  const double unit = drawing_.tolerance(unknown);
  return {drawn + unit * deviations_[at], unit * std::sqrt(covariance_(at, at))};
}

Estimate CalibrationResult::angleOffset_deg(int gauge) const {
  const Estimate rad = of(gauge, kAngleOffset, 0);
  return {rad.value / kRadPerDeg, rad.sigma / kRadPerDeg};
}

Estimate CalibrationResult::coreRadius_m() const {
  return of(kCoreRadius, drawing_.config().finger.core_radius_m);
}

Estimate CalibrationResult::poissonRatio() const {
  return of(kPoissonRatio, drawing_.config().finger.poisson_ratio);
}

Estimate CalibrationResult::shearModulus_pa() const {
  const double modulus_pa = drawing_.annulus(deviations_).shear_modulus_pa;
  return {modulus_pa, modulus_pa * of(kShearModulus, 0).sigma};
}

double CalibrationResult::residual_strain(int gauge) const {
  double squares = 0;
  int rows = 0;
  for (const RowResult& row : rows_)
    if (row.use == RowUse::kFitted || row.use == RowUse::kUntouched) {
      squares += row.residual_strain[gauge] * row.residual_strain[gauge];
      ++rows;
    }
  return std::sqrt(squares / std::max(rows, 1));
}

int CalibrationResult::count(RowUse use) const {
  return static_cast<int>(
      std::count_if(rows_.begin(), rows_.end(), [use](const RowResult& row) { return row.use == use; }));
}

double CalibrationResult::turn_deg() const {
  double sum_deg = 0;
  for (int gauge = 0; gauge < drawing_.gauges(); ++gauge) sum_deg += angleOffset_deg(gauge).value;
  return sum_deg / drawing_.gauges();
}

double CalibrationResult::drawnTurn_deg() const {
  const config::Domain& domain = config::keyOf("calibration.angle_offset_deg").domain;
  for (int gauge = 0; gauge < drawing_.gauges(); ++gauge)
    if (!domain.contains(angleOffset_deg(gauge).value)) return toDigits(turn_deg(), kAngleDigits);
  return 0;
}

config::FingerConfig CalibrationResult::applied() const {
  config::FingerConfig config = drawing_.config();
  const config::Finger drawn = config.finger;
  config.finger.core_radius_m = toDigits(coreRadius_m().value, 9);
  config.finger.poisson_ratio = toDigits(std::min(poissonRatio().value, 0.5), 7);
  config.finger.shear_modulus_pa = toDigits(shearModulus_pa().value, 1);
  if (!config.as_built.isAsDrawn()) {
    config.as_built.core_radius_m += drawn.core_radius_m - config.finger.core_radius_m;
    config.as_built.poisson_ratio += drawn.poisson_ratio - config.finger.poisson_ratio;
    config.as_built.shear_modulus_pa += drawn.shear_modulus_pa - config.finger.shear_modulus_pa;
  }
  config.gauges.model_error = toDigits(std::hypot(modelError_.value, modelError_.sigma), 6);
  const CalibrationErrors errors = calibrationErrors(*this);
  config.calibration = {};
  config.calibration.place_error_m = toDigits(errors.place_m, 8);
  config.calibration.load_error = toDigits(errors.load, 5);
  config.calibration.moment_error_m2 = toDigits(errors.moment_m2, 11);
  const double turned_deg = drawnTurn_deg();
  if (turned_deg != 0) turn(config.gauges, turned_deg);
  for (int gauge = 0; gauge < drawing_.gauges(); ++gauge) {
    config.calibration.gain.push_back(toDigits(gain(gauge).value, 6));
    config.calibration.angle_offset_deg.push_back(
        toDigits(angleOffset_deg(gauge).value - turned_deg, kAngleDigits));
    config.calibration.depth_offset_m.push_back(toDigits(depthOffset_m(gauge).value, 9));
  }
  return config;
}

}  // namespace strainfinger::calibration
