#pragma once
// How far noise alone draws a fitted finger to one side.

#include <Eigen/Core>
#include <vector>

#include "host/calibration/joint_fit.hpp"

namespace strainfinger::calibration {

/// What noise adds to the fitted deviations on average, to second order. Every touch has four unknowns of its
/// own, in which readings are curved; noise of a place never averages out of what its curvature makes of the
/// finger, as more touches bring more places (Neyman & Scott 1948). Beside the sigmas, which shrink with the
/// root of the touches, it grows: a quarter of Poisson's ratio's after 300, one after 3,000.
///
/// Cost: 0.7 ms a touch.
Eigen::VectorXd noiseBias(const Drawing& drawing, int lastHarmonic, const std::vector<TouchData>& data,
                          const JointFit& fit, const Eigen::MatrixXd& covariance);

}  // namespace strainfinger::calibration
