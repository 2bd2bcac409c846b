#pragma once
// One finger and all its touches, fitted together.

#include <Eigen/Core>
#include <vector>

#include "host/calibration/touch_fit.hpp"

namespace strainfinger::calibration {

struct JointFit {
  Eigen::VectorXd deviations;       ///< of the finger, from the drawing
  std::vector<TouchState> touches;  ///< one each
};

/// Minimises the chi-squared of all readings, of what is known of touches, and of the finger's deviations
/// from the drawing (bundle adjustment: the touches are the points, the finger is the camera; Ceres, Schur
/// complement). With `robust` a touch whose chi-squared is beyond that counts with a slope that falls with
/// it (Cauchy's loss); 0: least squares. Moves `fit` from where it is.
/// Cost: linear in the touches, 0.1 ms each an iteration; ten as a rule.
void fitTogether(const Drawing& drawing, int lastHarmonic, const std::vector<TouchData>& data, double robust,
                 JointFit& fit);

/// Covariance of the finger's deviations: the inverse of what readings and prior tell of them together
/// (Schur complement of the touches). Exact for small noise. Cost: 50 us a touch.
Eigen::MatrixXd covarianceOf(const Drawing& drawing, int lastHarmonic, const std::vector<TouchData>& data,
                             const JointFit& fit);

}  // namespace strainfinger::calibration
