#pragma once
// Where a contact is, told at once from how differently the gauges on either side of the deepest one read.

#include <array>

#include "common/table_image.hpp"
#include "host/model/impulse_response.hpp"

namespace strainfinger::tables {

/// By the share that the deepest reading has of the ring's energy: the weights of the pairs' differences
/// whose sum comes closest to the offset of the contacts that have this share, in the mean square over places
/// up to 0.6 pitch from that gauge and loads within `cone`, with noise of 0.2 % of its reading. None where
/// more than 3 of 10 of all of them would start more than 1/16 pitch off. Cost: the responses of a ring at
/// 129 offsets.
std::array<StartWeights, kShares> startWeights(const model::ImpulseResponse& response, int gaugeCount,
                                               double cone);

}  // namespace strainfinger::tables
