#pragma once
// The finger as elasticity sees it.

namespace strainfinger::model {

/// A rubber annulus r_a <= r <= r_b bonded to a rigid core, in plane strain (paper, sec. 2.1).
/// Domain: 0 < core_radius_m < outer_radius_m, shear_modulus_pa > 0, 0 <= poisson_ratio <= 1/2.
template <typename Scalar>
struct Annulus {
  Scalar core_radius_m;
  Scalar outer_radius_m;
  Scalar shear_modulus_pa;
  Scalar poisson_ratio;
};

}  // namespace strainfinger::model
