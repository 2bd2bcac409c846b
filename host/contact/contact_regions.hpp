#pragma once
// Roughly where a measured shape touches: how many regions, and about which edges. EdgeSearch makes them
// exact.

#include <vector>

#include "host/contact/contact.hpp"

namespace strainfinger::contact {

/// The regions of a frictionless contact of the size asked for, in rising order, to a few parts in a hundred
/// of the whole. By Signorini's conditions on 128 cells of uniform pressure and an active set, over the
/// measured range first and then over what touched, until that fills the cells; then cells that touch are cut
/// where the shape is rough. A width is found by trying loads. A measured point that stands out makes all of
/// its cell stand out; settleRegions() has it exactly. Throws Failure(kFailure) if no load makes a contact of
/// that width (where another region comes to touch, it jumps), and if 900 cells don't resolve the shape.
/// Costs 10 ms for a load, 20 ms for a width, 0.3 s where many cells are cut.
std::vector<Patch> findRegions(const SurfaceKernel& kernel, const Indenter& indenter,
                               const ContactSize& size);

/// One region about the lowest place of a measured shape on the undeformed surface, as wide as asked for or
/// as a parabola would be that fills as much below the same level under the load: where shapes have one
/// region, close enough for EdgeSearch. Costs 60 us for 800 points.
Patch guessRegion(const SurfaceKernel& kernel, const Indenter& indenter, const ContactSize& size);

}  // namespace strainfinger::contact
