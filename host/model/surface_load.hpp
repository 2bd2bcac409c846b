#pragma once
// A load on the surface and its Fourier coefficients.

#include <numbers>

#include "host/model/annulus.hpp"

namespace strainfinger::model {

/// A load on the surface, uniform over its width.
struct SurfaceLoad {
  double normal_n_per_m = 0;      ///< positive: pressing
  double tangential_n_per_m = 0;  ///< positive: towards +theta
  double centre_rad = 0;
  double width_rad = 0;  ///< 0 (a line load) to 2 pi
};

/// p_n^c and q_n^c [Pa], n >= 1, of a load's two parts as line loads at theta = 0, tension positive; n = 0
/// has half of them.
struct LineCoefficients {
  double normal, tangential;

  LineCoefficients(const Annulus<double>& annulus, const SurfaceLoad& load)
      : normal(-load.normal_n_per_m / (std::numbers::pi * annulus.outer_radius_m)),
        tangential(load.tangential_n_per_m / (std::numbers::pi * annulus.outer_radius_m)) {}
};

}  // namespace strainfinger::model
