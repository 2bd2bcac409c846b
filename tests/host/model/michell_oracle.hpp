#pragma once
// The response of one harmonic by another route than the product's: the Michell stress functions r^n, r^-n,
// r^(n+2), r^(2-n) (for n = 0: ln r, r^2 and the rotations; for n = 1: 1/r, r^3, the single-valued
// combination of r ln r sin theta and r theta cos theta, and the translation), their stresses and
// displacements from the paper's sec. 2.3, and the four boundary conditions as a linear system, in 100
// digits.

#include "host/model/harmonic.hpp"

namespace strainfinger::testing {

/// Rounded to long double, whose range is needed: nothing underflows for n up to 2500.
model::HarmonicResponse<long double> exactResponse(const model::Annulus<double>& finger, double radius_m,
                                                   int n);

}  // namespace strainfinger::testing
