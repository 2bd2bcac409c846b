#pragma once
// Strains, stresses and displacements in the rubber under a contact.

#include <Eigen/Core>
#include <span>

#include "host/contact/fourier_tractions.hpp"
#include "host/model/harmonic.hpp"

namespace strainfinger::contact {

/// Most harmonics a contact's field may need: depths from 2e-3 r_b on at a tolerance of 1e-15.
inline constexpr int kMostFieldHarmonics = 20'000;

/// Below the surface the field is computed at radii less than this [m]: between it and r_b more than
/// kMostFieldHarmonics were needed.
double fieldLimit_m(const model::Annulus<double>& annulus, double tolerance = 1e-15);

/// One row an angle (from the indenter's normal), one column each of `rows`, in SI units. Below the surface
/// by model::truncatedSeries(), whose tolerance is that of a line load's field and so more than kept here; at
/// r_b itself by SurfaceMotion and Hooke's law, with NaN or infinity at edges where strains have none.
/// Domain: r_a <= radius_m < fieldLimit_m(), 0.2 % below r_b, and r_b. Throws Failure(kUsage) outside it.
/// Error: 1e-13 of the peak; at r_b as SurfaceMotion.
Eigen::MatrixXd computeContactField(const SurfaceKernel& kernel, const Tractions& tractions, double radius_m,
                                    std::span<const double> angles_rad, std::span<const model::Row> rows,
                                    double tolerance = 1e-15);

}  // namespace strainfinger::contact
