#pragma once
// Fingers to press on.

#include "host/model/annulus.hpp"

namespace strainfinger::testing {

inline constexpr double kSurface_m = 12.7e-3;
inline constexpr model::Annulus<double> kDefaultFinger{8.9e-3, kSurface_m, 8.3e4, 0.5};

/// As the default finger, but for alpha = r_a / r_b and Poisson's ratio.
inline model::Annulus<double> fingerOf(double alpha, double poissonRatio) {
  return {alpha * kSurface_m, kSurface_m, kDefaultFinger.shear_modulus_pa, poissonRatio};
}

}  // namespace strainfinger::testing
