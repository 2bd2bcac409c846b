#pragma once
// Which regions of a measured shape touch, and where they end.

#include <optional>
#include <vector>

#include "host/contact/edge_search.hpp"

namespace strainfinger::contact {

/// The contact if it is one region on a smooth shape, as guessRegion() has it about: a few terms converge,
/// the shape is nowhere inside the rubber and nothing pulls, so that it is the contact. Costs 1 ms.
std::optional<EdgeResult> settlePlainRegion(const SurfaceKernel& kernel, const ContactRequest& request,
                                            int& terms);

/// Edges of the regions guessed, then of those that Signorini's conditions want besides: where the shape is
/// inside the rubber another region begins, one that pulls as a whole goes, one that pulls somewhere is cut
/// there, two that grow into each other become one; until nothing penetrates by more than 1e-12 m (and twice
/// the residual) and nothing pulls. Throws Failure(kFailure) that says where if the regions become more than
/// 16 or don't settle in 10 rounds, and if the width asked for is one that the contact jumps over.
/// Each region has 24 terms if these converge, or 64, or, of one or two, 160; `terms` tells.
EdgeResult settleRegions(const SurfaceKernel& kernel, const ContactRequest& request,
                         std::vector<Patch> patches, int& terms);

}  // namespace strainfinger::contact
