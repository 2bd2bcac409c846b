#pragma once
// The touch that explains readings best: maximum likelihood under independent, equal, normal noise.

#include "host/shape/touch_model.hpp"

namespace strainfinger::shape {

struct TouchFit {
  Touch touch;
  Eigen::Matrix4d covariance;  ///< of its members in their order; infinite where readings don't tell
  double chiSquared = 0;       ///< sum of squared residuals over the noise's variance
  bool isAtLimit = false;      ///< the moment is at an end of what the model allows
};

/// From a start in its basin to the least sum of squares (Levenberg 1944, Marquardt 1963), the moment kept
/// within the model's limits. Costs 5 to 15 responses of the model.
TouchFit refine(const TouchModel& model, Profile profile, const Eigen::VectorXd& strains, double noise,
                const Touch& start);

/// a - b, member by member; angles the short way round.
Eigen::Vector4d difference(const Touch& a, const Touch& b);

/// Whether a touch differs from a fit by so many of its sigmas, in any of its members.
bool areApart(const TouchFit& fit, const Touch& touch, double sigmas);

}  // namespace strainfinger::shape
