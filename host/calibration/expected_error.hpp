#pragma once
// What a calibration is worth: errors of touches to come.

#include <Eigen/Core>
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

/// The touches by which a calibration is judged: of 30 N/m over 2 mm everywhere on the ring, pressed and
/// rubbed either way.
std::vector<TouchState> judgedTouches(const Drawing& drawing);

/// A covariance of deviations, given the mean of the angles and the modulus: the zero of the angle and the
/// unit of force are conventions where nothing is known of a touch.
Eigen::MatrixXd withoutConventions(const Drawing& drawing, const Eigen::MatrixXd& covariance);

/// Of the judged touches: RMS of place [m], normal and tangential load [N/m].
struct ExpectedErrors {
  Eigen::Vector3d before;  ///< located as if the finger were as drawn: what the calibrated one makes of that
  Eigen::Vector3d after;   ///< located with the finger as calibrated: noise and what is not known of it
  Eigen::Vector3d bound;   ///< noise alone
};

/// Costs 0.2 s.
ExpectedErrors expectedErrors(const CalibrationResult& result);

/// What is not known of the finger, as an error of readings: the standard deviation of independent errors of
/// all readings, as a fraction of the touch's largest, with which a locator's sigmas of the judged touches
/// are their errors (RMS of one over the other), in place, normal or tangential load, whichever asks for
/// most. What of the finger is not known but changes no touch doesn't count, nor do the zero of the angle and
/// the unit of force: what isn't known of these is right by convention. Costs 0.1 s.
double fingerError(const CalibrationResult& result);

/// Place as an arc of the surface, normal and tangential load; without the moment.
inline Eigen::Vector3d inMetres(const TouchState& touch, double outerRadius_m) {
  return {outerRadius_m * touch[kPlace], touch[kNormalLoad], touch[kTangentialLoad]};
}

}  // namespace strainfinger::calibration
