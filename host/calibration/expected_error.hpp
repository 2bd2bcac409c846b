#pragma once
// What a calibration is worth: errors of touches to come.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "host/calibration/calibrate.hpp"

namespace strainfinger::calibration {

/// Variances of a touch's unknowns as a fit of its readings alone finds them.
struct TouchVariances {
  TouchState noise;  ///< by noise: Cramer-Rao's bound
  TouchState total;  ///< and by the covariance of the finger's deviations
};
TouchVariances touchVariances(const RingResponse& ring, const TouchState& touch,
                              const Eigen::MatrixXd& covariance, double noise_strain);

/// The touches by which a calibration is judged: of one load and width everywhere on the ring, pressed and
/// rubbed either way.
std::vector<TouchState> judgedTouches(const Drawing& drawing);
/// "touches of 30 N/m, 2 mm wide".
std::string judgedTouchesText();

/// A covariance of deviations, the zero of angles and the unit of force being given.
Eigen::MatrixXd withoutConventions(const Drawing& drawing, const Eigen::MatrixXd& covariance);

/// Of the judged touches: RMS of place [m], normal and tangential load [N/m].
struct ExpectedErrors {
  /// Located as if the finger were as drawn: by as much as the calibrated one is off that, and by what
  /// `after` holds, which the calibration doesn't know of the drawing either.
  Eigen::Vector3d before;
  Eigen::Vector3d after;  ///< located with the finger as calibrated: noise and what is not known of it
  Eigen::Vector3d bound;  ///< noise alone
};

/// Costs 0.1 s.
ExpectedErrors expectedErrors(const CalibrationResult& result);

/// What is not known of the finger makes of touches to come: standard errors that all of them share, whatever
/// their load and width (README.md beside this file has figures). RMS over the judged touches.
struct CalibrationErrors {
  double place_m;    ///< an arc of the surface
  double load;       ///< of the normal or the tangential load, whichever is larger, over the normal load
  double moment_m2;  ///< of the pressure's second moment
};

/// Where no load is known, loads are off by what the drawing's modulus may be. Costs 10 ms.
CalibrationErrors calibrationErrors(const CalibrationResult& result);

/// Place as an arc of the surface, normal and tangential load; without the moment.
inline Eigen::Vector3d inMetres(const TouchState& touch, double outerRadius_m) {
  return {outerRadius_m * touch[kPlace], touch[kNormalLoad], touch[kTangentialLoad]};
}

}  // namespace strainfinger::calibration
