#pragma once
// What a finger as built may be: the vector that the fit moves, and what it stands for.

#include <Eigen/Core>
#include <vector>

#include "host/config/finger_config.hpp"
#include "host/model/annulus.hpp"
#include "host/model/placed_gauge.hpp"

namespace strainfinger::calibration {

/// The unknowns of one gauge, in the order of the vector.
enum GaugeUnknown : Eigen::Index { kGain, kZero, kAngleOffset, kDepthOffset, kGaugeUnknowns };
/// The unknowns of the rubber, behind those of all gauges.
enum RubberUnknown : Eigen::Index { kCoreRadius, kPoissonRatio, kShearModulus, kRubberUnknowns };

/// Where angles count from.
enum class ZeroOfAngle {
  kByConvention,  ///< where the drawing has the gauges on average: no touch tells otherwise
  kKnown,         ///< from known directions, by which the ring as a whole may be turned
};

/// How a FingerConfig's [finger], [gauges] and [tolerance] turn a vector of deviations into a finger. Each
/// deviation is counted in its tolerance.
class Drawing {
 public:
  explicit Drawing(const config::FingerConfig& config, ZeroOfAngle zeroOfAngle = ZeroOfAngle::kByConvention)
      : config_(config), zeroOfAngle_(zeroOfAngle) {}

  int gauges() const { return config_.gauges.count; }
  Eigen::Index unknowns() const { return kGaugeUnknowns * gauges() + kRubberUnknowns; }
  static Eigen::Index at(int gauge, GaugeUnknown unknown) { return kGaugeUnknowns * gauge + unknown; }
  Eigen::Index at(RubberUnknown unknown) const { return kGaugeUnknowns * gauges() + unknown; }

  /// Of a deviation of 1: what it changes, [1], [strain], [rad], [m]; [m], [1], and of the modulus'
  /// logarithm.
  double tolerance(GaugeUnknown unknown) const;
  double tolerance(RubberUnknown unknown) const;
  ZeroOfAngle zeroOfAngle() const { return zeroOfAngle_; }
  /// The prior is that of standard normal deviates, but for the mean of the angles: this matrix times the
  /// deviations has the identity as covariance.
  Eigen::MatrixXd priorRoot() const;
  /// Of the mean of the angles' deviations: its prior's standard deviation.
  double turnDeviation() const;
  /// Of the deviations of Poisson's ratio, that of 1/2: rubber isn't compressed more than not at all.
  double mostPoissonDeviation() const {
    return (0.5 - config_.finger.poisson_ratio) / tolerance(kPoissonRatio);
  }

  model::Annulus<double> annulus(const Eigen::VectorXd& deviations) const;
  model::PlacedGauge gauge(const Eigen::VectorXd& deviations, int gauge) const;
  double zero_strain(const Eigen::VectorXd& deviations, int gauge) const {
    return tolerance(kZero) * deviations[at(gauge, kZero)];
  }

  const config::FingerConfig& config() const { return config_; }

 private:
  config::FingerConfig config_;
  ZeroOfAngle zeroOfAngle_;
};

}  // namespace strainfinger::calibration
