#pragma once
// Gauges must be where the rubber is strained.

#include "host/config/finger_config.hpp"

namespace strainfinger::config {

/// `strainPerLoad`: the largest at the gauges, of any line load or harmonic of one [strain per N/m]. Throws
/// Failure(kUsage) where it is none: on the core, of a component that bonding or incompressible rubber
/// suppresses there.
void requireStrain(const FingerConfig& config, double strainPerLoad);

}  // namespace strainfinger::config
