#pragma once
// Where a measured shape is inside the rubber although nothing presses there.

#include <vector>

#include "host/contact/indenter.hpp"
#include "host/contact/surface_kernel.hpp"
#include "host/contact/tractions.hpp"

namespace strainfinger::contact {

struct Overlap {
  Patch run;           ///< where it is inside
  double deepest_rad;  ///< where it is deepest inside
  double depth_m;      ///< there
};

/// Overlaps deeper than `tolerance_m` outside the patches, in rising order, over all of the measured shape.
/// Looks at every measured point and three places between any two, and follows what is nearly touching to its
/// deepest point: the shape is the spline through its points. Domain: a measured indenter. Costs 5 us for
/// each place not plainly above the surface, 2 ms in all for 800 points.
std::vector<Overlap> findOverlaps(const SurfaceKernel& kernel, const Indenter& indenter,
                                  const Tractions& tractions, double approach_m, double tolerance_m);

}  // namespace strainfinger::contact
