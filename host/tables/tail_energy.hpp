#pragma once
// What a contact leaves outside the window of gauges that a fit looks at.

#include "host/model/impulse_response.hpp"

namespace strainfinger::tables {

/// The largest energy (sum of squared strains) that a contact leaves outside its window, over the energy
/// inside: wherever it is, loads within `cone` (largest |tangential| / normal). 0 where the window is the
/// whole ring. Cost: one response for each gauge at 33 offsets.
double tailEnergy(const model::ImpulseResponse& response, int gaugeCount, double cone);

}  // namespace strainfinger::tables
