#pragma once
// What a calibration knows of the finger by now, and what further touches would gain.

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "host/calibration/calibrate.hpp"

namespace strainfinger::session {

/// Standard deviations of what is known of a gauge.
struct GaugeSigmas {
  double gain = 0, zero_strain = 0, angle_deg = 0, depth_m = 0;
};

/// Errors of touches to come, RMS over the ring: place [m], normal and tangential load [N/m].
struct TouchesToCome {
  Eigen::Vector3d drawn = Eigen::Vector3d::Zero();  ///< as if the finger were as drawn
  Eigen::Vector3d known =
      Eigen::Vector3d::Zero();  ///< as it is known by now, the zero of angles and the unit of force given
  Eigen::Vector3d bound = Eigen::Vector3d::Zero();  ///< by noise alone
};

struct Assessment {
  std::size_t rows = 0;    ///< that it is of
  std::size_t fitted = 0;  ///< of these
  std::vector<GaugeSigmas> gauges;
  TouchesToCome errors;
  double unitOfForce = 0;  ///< sigma of the relative error that the loads of all touches to come share
  double zeroOfAngle_deg = std::numeric_limits<double>::infinity();  ///< sigma; infinite: no mark is known
  /// By what share so many further touches in an arc, pressed with various loads and rubbed to either side,
  /// would lower the errors of touches to come; and all around.
  std::vector<double> arcGains;
  double gainAllAround = 0;
  /// Of each gauge: sigma of the unit of force after one more press of known load over it.
  std::vector<double> unitAfterPress;

  double bestGain() const;
};

/// Errors of known loads as for calibrate().
Assessment assess(const calibration::CalibrationResult& result, const calibration::KnownErrors& errors);

}  // namespace strainfinger::session
