#pragma once
// The finger as it was built.

#include <vector>

#include "host/config/finger_config.hpp"
#include "host/model/annulus.hpp"

namespace strainfinger::simulation {

/// What there really is, whatever the drawing and the calibration say.
struct BuiltFinger {
  model::Annulus<double> annulus;
  std::vector<model::PlacedGauge> gauges;
};

/// Without [as_built] the finger is exactly as configured: the drawing and what calibration found. With it,
/// the finger is the drawing and the differences drawn by its seed, and [calibration] is no more than what
/// the firmware was told. No gauge leaves the rubber: its radius is at least the core's, at most midway
/// between where it was drawn and the surface.
BuiltFinger builtFinger(const config::FingerConfig& config);

}  // namespace strainfinger::simulation
