#include "host/calibration/finger_state.hpp"

#include <cmath>

#include "host/base/angles.hpp"

namespace strainfinger::calibration {

double Drawing::tolerance(GaugeUnknown unknown) const {
  switch (unknown) {
    case kGain:
      return config_.tolerance.gain;
    case kZero:
      return config_.tolerance.zero_strain;
    case kAngleOffset:
      return config_.tolerance.angle_deg * kRadPerDeg;
    default:
      return config_.tolerance.depth_m;
  }
}

double Drawing::tolerance(RubberUnknown unknown) const {
  switch (unknown) {
    case kCoreRadius:
      return config_.tolerance.core_radius_m;
    case kPoissonRatio:
      return config_.tolerance.poisson_ratio;
    default:
      return config_.tolerance.shear_modulus;
  }
}

model::Annulus<double> Drawing::annulus(const Eigen::VectorXd& deviations) const {
  model::Annulus<double> annulus = config_.finger.annulus();
  annulus.core_radius_m += tolerance(kCoreRadius) * deviations[at(kCoreRadius)];
  annulus.poisson_ratio += tolerance(kPoissonRatio) * deviations[at(kPoissonRatio)];
  annulus.shear_modulus_pa *= std::exp(tolerance(kShearModulus) * deviations[at(kShearModulus)]);
  return annulus;
}

model::PlacedGauge Drawing::gauge(const Eigen::VectorXd& deviations, int gauge) const {
  model::PlacedGauge placed = config_.drawn(gauge);
  placed.gain += tolerance(kGain) * deviations[at(gauge, kGain)];
  placed.angle_rad += tolerance(kAngleOffset) * deviations[at(gauge, kAngleOffset)];
  placed.radius_m -= tolerance(kDepthOffset) * deviations[at(gauge, kDepthOffset)];
  return placed;
}

}  // namespace strainfinger::calibration
