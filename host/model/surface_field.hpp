#pragma once
// The field at r_b under a load of some width, where no power of r / r_b makes the series converge.

#include <Eigen/Core>
#include <span>

#include "host/model/harmonic.hpp"
#include "host/model/surface_load.hpp"

namespace strainfinger::model {

/// As computeField() at r_b, for 0 < width_rad <= 2 pi. What a half-plane-like body without a core responds,
/// c_0 + c_1 / (n - 1) + c_2 / (n + 1) for n >= 2, sums to logarithms and saw-teeth over the load's edges;
/// the rest, which the core reflects, falls like n^2 alpha^2n and is summed until it is rounding, both in
/// long double. Error: stability.md, at worst 2e-15 of the peak (alpha = 0.999). Costs 1 us a harmonic and 30
/// ns a harmonic, angle and column, of which there are 18 / (1 - alpha) and more. Stresses and strains jump
/// at the edges of the load (there: the mean of both sides) and those that are logarithms there are infinite
/// at the very edge.
Eigen::MatrixXd computeSurfaceField(const Annulus<double>& annulus, const SurfaceLoad& load,
                                    std::span<const double> angles_rad, std::span<const Row> rows);

}  // namespace strainfinger::model
