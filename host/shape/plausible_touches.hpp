#pragma once
// Which touches explain readings about as well as the best one does.

#include <vector>

#include "host/shape/touch_fit.hpp"

namespace strainfinger::shape {

/// A place and a moment with the loads that explain readings best from there.
struct PlausibleTouch {
  Touch touch;
  Eigen::Matrix2d loadCovariance;  ///< of the loads, place and moment being known
  double chiSquared = 0;
  double area = 0;  ///< of angle and moment that it stands for [rad^3]
};

struct PlausibleTouches {
  std::vector<PlausibleTouch> touches;
  /// False where the valley is longer than kMostPlaces, or too narrow and bent to be followed.
  bool areAll = false;
};

/// Places on a lattice of 1.25 sigmas of the fit, from the fit on as far as chi squared stays within
/// kPlausible of it: all of a valley that the fit lies in, straight or bent; shorter steps along it where it
/// is bent so much that it is lost at once. None where the fit has no finite sigmas. Costs a response of the
/// model a place: some 40 where the model is as linear as its sigmas say, kMostPlaces at most.
PlausibleTouches plausibleTouches(const TouchModel& model, const Eigen::VectorXd& strains, double noise,
                                  const TouchFit& fit);

/// 3.7 sigma: of a normal distribution in the plane 1 in 1,100 lies farther out, with 0.7 % of its variance.
inline constexpr double kPlausible = 14;
inline constexpr std::size_t kMostPlaces = 600;

}  // namespace strainfinger::shape
