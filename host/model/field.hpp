#pragma once
// Stresses, strains and displacements under one load, at one radius.

#include <Eigen/Core>
#include <span>

#include "host/model/harmonic.hpp"
#include "host/model/surface_load.hpp"

namespace strainfinger::model {

/// One row an angle, one column each of `rows`, in SI units; only those are summed.
///
/// Below the surface: by truncatedSeries(), whose demands on radius and tolerance hold here. Error besides
/// the tolerance, which is relative to the peak: stability.md, 5e-15 of the peak with 400,000 harmonics, and
/// what the rounding of the angle makes of the slope. Costs 0.2 us a harmonic and a few ns a harmonic, angle
/// and column; nothing for a load that is 0.
///
/// At r_b itself a load of some width has a solution, in closed form but for a few harmonics that the core
/// reflects (surface_field.hpp); a line load has none: Failure(kUsage).
Eigen::MatrixXd computeField(const Annulus<double>& annulus, double radius_m, const SurfaceLoad& load,
                             std::span<const double> angles_rad, std::span<const Row> rows,
                             double tolerance = 1e-15);

}  // namespace strainfinger::model
