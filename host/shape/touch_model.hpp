#pragma once
// What the ring's gauges read of a touch whose load is spread.

#include <Eigen/Core>

#include "host/config/finger_config.hpp"
#include "host/model/impulse_response.hpp"
#include "host/model/pressure_profile.hpp"

namespace strainfinger::shape {

using model::allProfiles;
using model::equivalentWidth_rad;
using model::halfWidth_rad;
using model::momentOfWidth;
using model::Profile;
using model::SpreadFactor;
using model::spreadFactor;

/// A touch: normal and tangential load, both spread by the same profile.
struct Touch {
  double angle_rad = 0;
  double normal_n_per_m = 0;
  double tangential_n_per_m = 0;
  /// Second moment of the load about angle_rad; below 0: continued, as spreadFactor().
  double moment_rad2 = 0;
};

/// The moment's place among a touch's members, in slopes and covariances.
inline constexpr int kMoment = 3;

/// The strains of a touch and their derivatives to its members, in their order: one row a gauge.
struct TouchStrains {
  Eigen::VectorXd strains;
  Eigen::MatrixX4d slopes;
};

/// The finger's linear response at all its gauges, each at the angle and depth that calibration found: 1e-14
/// of the peak, for moments from leastMoment_rad2() on 1e-7. Immutable; costs 0.1 ms a gauge to make.
class TouchModel {
 public:
  /// Of the config's finger, gauges and calibration, but for the gains: strains are those of gauges of
  /// gain 1. Throws Failure(kUsage) where the gauges would read nothing.
  explicit TouchModel(const config::FingerConfig& config);

  /// Costs 20 us for 32 gauges in the default finger.
  TouchStrains respond(Profile profile, const Touch& touch) const;

  /// One column a place [rad]: what the gauges read per N/m of a normal line load there.
  Eigen::MatrixXd normalLineStrains(const Eigen::VectorXd& angles_rad) const;

  int gauges() const { return static_cast<int>(normal_.rows()); }
  double gaugeAngle_rad(int gauge) const { return angles_rad_[gauge]; }
  double outerRadius_m() const { return outerRadius_m_; }
  /// Mean depth of the gauges below the surface over r_b: the scale of what they can tell apart.
  double depth() const { return depth_; }

  /// Moments that a fit may try: down to where the series of the continued ellipse converges half as fast as
  /// a line load's, and up to a width of 1 rad.
  double leastMoment_rad2() const;
  static constexpr double kMostMoment_rad2 = momentOfWidth(1);

 private:
  void addGauge(Eigen::Index gauge, const model::ImpulseResponse& line);

  Eigen::VectorXd orders_;
  Eigen::VectorXd angles_rad_;
  /// What the gauges read of loads whose harmonics are cos n angle (left half) and sin n angle (right half).
  Eigen::MatrixXd normal_, tangential_;
  double outerRadius_m_;
  double depth_;
  double leastDepth_;  ///< of all gauges: the one that feels the highest harmonics
};

}  // namespace strainfinger::shape
