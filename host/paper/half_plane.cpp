#include "host/paper/half_plane.hpp"

#include <cmath>
#include <numbers>

namespace strainfinger::paper {

Strains HalfPlane::strains(const Strains& stresses) const {
  const double nu = poisson_ratio;
  Eigen::Matrix3d hooke;
  hooke << 1 - nu, -nu, 0, -nu, 1 - nu, 0, 0, 0, 1;
  return hooke * stresses / (2 * shear_modulus_pa);
}

Strains HalfPlane::atWaveNumber(double k_per_m) const {
  const double depth = k_per_m * depth_m;
  Strains stresses;
  stresses << 1 + depth, -depth, 1 - depth, depth - 2, depth, 1 - depth;
  return strains(stresses * std::exp(-depth));
}

Strains HalfPlane::atArc(double x_m) const {
  const double z = depth_m, x = x_m, distance = std::hypot(x, z);
  const double scale = -2 / (std::numbers::pi * distance);
  const double c = z / distance, s = x / distance;
  Strains stresses;
  stresses << c * c * c, s * c * c, s * s * c, s * s * s, -s * c * c, -s * s * c;
  return strains(scale * stresses);
}

}  // namespace strainfinger::paper
