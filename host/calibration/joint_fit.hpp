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

enum class FitEnd {
  kSettled,
  kStopped,  ///< after as many iterations as are made at most, better than it was, and not at its best
  kFailed,   ///< nothing has moved: the model or the equations have no finite answer
};

/// Minimises the chi-squared of all readings, of what is known of touches, and of the finger's deviations
/// from the drawing (bundle adjustment: the touches are the points, the finger is the camera; Ceres, Schur
/// complement). With `robust` a touch whose chi-squared is beyond that counts with a slope that falls with
/// it (Cauchy's loss); 0: least squares. Moves `fit` from where it is.
/// Cost: linear in the touches, 0.1 ms each an iteration; ten as a rule.
FitEnd fitTogether(const Drawing& drawing, int lastHarmonic, const std::vector<TouchData>& data,
                   double robust, JointFit& fit);

/// Domain: symmetric. Throws Failure(kFailure) where it is not positive definite: its values are no
/// information then.
Eigen::MatrixXd inverseOf(const Eigen::MatrixXd& information);

/// Covariance of the finger's deviations: the inverse of what readings and prior tell of them together
/// (Schur complement of the touches). Exact for small noise. Throws Failure(kFailure) where rounding leaves
/// no information that could be inverted. Cost: 50 us a touch.
Eigen::MatrixXd covarianceOf(const Drawing& drawing, int lastHarmonic, const std::vector<TouchData>& data,
                             const JointFit& fit);

}  // namespace strainfinger::calibration
