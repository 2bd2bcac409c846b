#pragma once
// Fingers to press on.

#include "tests/host/model/fingers.hpp"

namespace strainfinger::testing {

inline constexpr double kSurface_m = kDefaultFinger.outer_radius_m;

/// As the default finger, but for alpha = r_a / r_b and Poisson's ratio.
inline model::Annulus<double> fingerOf(double alpha, double poissonRatio) {
  return {alpha * kSurface_m, kSurface_m, kDefaultFinger.shear_modulus_pa, poissonRatio};
}

}  // namespace strainfinger::testing
