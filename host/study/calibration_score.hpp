#pragma once
// How near a calibration came to the truth that the simulator knows.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "host/calibration/calibrate.hpp"

namespace strainfinger::study {

/// The deviations that the simulated finger really has, in the order and units of the calibration's.
Eigen::VectorXd trueDeviations(const config::FingerConfig& finger);

/// Errors of all unknowns of a finger over their reported sigmas; zeros and what no touch tells included.
Eigen::VectorXd errorsOverSigma(const calibration::CalibrationResult& result,
                                const config::FingerConfig& finger);

/// Draws of NewTouches::byChance.
inline constexpr Eigen::Index kChances = 200;

/// RMS over many new touches, of place [m], normal and tangential load [N/m].
struct NewTouches {
  Eigen::Vector3d error;      ///< located with the finger as calibrated, less the truth
  Eigen::Vector3d predicted;  ///< what noise and the calibration's covariance make of it
  /// What chance makes of error / predicted where the calibration's errors are as its covariance has them: a
  /// column a draw of the finger's errors, which all touches share, and of each touch's noise.
  Eigen::Matrix3Xd byChance;
  Eigen::Vector3d bound;    ///< Cramer-Rao's of the finger perfectly known, the width not
  double load_n_per_m = 0;  ///< the normal load itself
};

/// `count` touches of 30 N/m and 2 mm anywhere on the ring and within 45 degrees of pressing, located in
/// double precision.
NewTouches newTouches(const calibration::CalibrationResult& result, const config::FingerConfig& finger,
                      int count, std::uint64_t seed);

}  // namespace strainfinger::study
