#pragma once
// Which regions of a measured shape touch, and where they end.

#include <vector>

#include "host/contact/edge_search.hpp"

namespace strainfinger::contact {

/// Edges of the regions guessed, then of those that Signorini's conditions want besides: where the shape is
/// inside the rubber another region begins, one that pulls as a whole goes, one that pulls somewhere is cut
/// there, two that grow into each other become one; until nothing penetrates by more than 1e-12 m and nothing
/// pulls, or after 24 rounds as far as that is (checkContact() tells). Throws Failure(kFailure) if the
/// regions become more than 16.
EdgeResult settleRegions(const SurfaceKernel& kernel, const SpectralSolver& solver,
                         const ContactRequest& request, std::vector<Patch> patches);

}  // namespace strainfinger::contact
