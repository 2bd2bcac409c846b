#pragma once
// How far a contact may be from the gauge that reads most.

#include <array>

#include "common/table_image.hpp"
#include "host/model/impulse_response.hpp"

namespace strainfinger::tables {

/// Rows to scan around the gauge with the deepest reading, by its share of the ring's energy: those beside
/// which any contact lies that gives it this share, or up to 1/64 more or less of it (noise), wherever it is,
/// loads within `cone` (largest |tangential| / normal; 1 if less). Cost: the responses of a ring at 129
/// offsets.
std::array<ScanSpan, kShares> scanSpans(const model::ImpulseResponse& response, int gaugeCount, double cone);

}  // namespace strainfinger::tables
