#include "host/calibration/finger_state.hpp"

#include <cmath>

#include "host/base/angles.hpp"

namespace strainfinger::calibration {
namespace {

/// Of the tolerance of one gauge's angle: a ring is glued by hand to the mark that directions count from, and
/// nothing but known directions tells how far it is turned. By convention it isn't, as good as exactly.
constexpr double kTurn = 20, kNoTurn = 1e-3;

}  // namespace

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

double Drawing::turnDeviation() const { return zeroOfAngle_ == ZeroOfAngle::kKnown ? kTurn : kNoTurn; }

Eigen::MatrixXd Drawing::priorRoot() const {
  const double root = std::sqrt(static_cast<double>(gauges()));
  Eigen::VectorXd together = Eigen::VectorXd::Zero(unknowns());  // of unit length
  for (int gauge = 0; gauge < gauges(); ++gauge) together[at(gauge, kAngleOffset)] = 1 / root;
  const double weight = 1 / (root * turnDeviation());
  return Eigen::MatrixXd::Identity(unknowns(), unknowns()) + (weight - 1) * together * together.transpose();
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
