#pragma once
// The elastic model as a fit of contacts sees it, in double precision.

#include <Eigen/Core>
#include <span>

#include "host/config/finger_config.hpp"
#include "host/model/gauge_ring.hpp"
#include "host/model/touch_load.hpp"
#include "host/simulation/scenario.hpp"

namespace strainfinger::evidence {

/// The parameters of a contact, in the order of all vectors of them: [rad], [N/m], [N/m], [rad^2].
enum Parameter : Eigen::Index { kAngle, kNormal, kTangential, kMoment };
using Parameters = Eigen::Vector4d;

/// A contact as a fit describes it: pressure and shear each of the profile and of a second moment.
struct FittedContact {
  double angle_rad = 0;
  model::TouchLoad load;

  Parameters parameters() const {
    return {angle_rad, load.normal_n_per_m, load.tangential_n_per_m, load.moment_rad2};
  }
};

/// Readings of the finger that the config describes, calibration included, and their derivatives.
class FitModel {
 public:
  explicit FitModel(const config::FingerConfig& config);

  /// The contact that a touch is to a fit: a semi-ellipse of its pressure's second moment, with the config's
  /// friction.
  FittedContact describe(const simulation::Touch& touch) const;

  /// One reading a gauge. Costs 50 us and 0.5 us a gauge a contact.
  Eigen::VectorXd readings(std::span<const FittedContact> contacts) const;

  /// Their derivatives to the contact's parameters: a row a gauge. The shear's second moment follows loads
  /// and moment as model::shearMoment_rad2() has it.
  Eigen::MatrixX4d slopes(const FittedContact& contact) const;

  int gauges() const { return ring_.count(); }
  double noise_strain() const { return config_.gauges.noise_strain; }

  /// Width [m] of the uniform pressure that has this second moment, and of a sigma of the moment: what the
  /// bus and the tables of results call width.
  double uniformWidth_m(double moment_rad2) const;
  double uniformWidthSigma_m(double moment_rad2, double sigmaMoment_rad2) const;

 private:
  config::FingerConfig config_;
  model::GaugeRing ring_;
};

}  // namespace strainfinger::evidence
