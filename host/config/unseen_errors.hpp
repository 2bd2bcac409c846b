#pragma once
// Errors of what is told of a touch that no residual shows.

#include "host/config/finger_config.hpp"

namespace strainfinger::config {

/// Standard errors that all touches of a finger have alike: of what its calibration left, and of how far a
/// finger may be off its model (gauges.model_error) without a trace in the readings.
struct UnseenErrors {
  double place_m;      ///< an arc of the surface
  double loadScale;    ///< of either load, over it
  double normalShare;  ///< of either load, over the normal load
  double moment_m2;    ///< of the pressure's second moment
};

/// [1] gauges.model_error; up to twice that for a finger that is not calibrated and whose gauges read so much
/// otherwise where they are off their depth, as near the core. Of a valid config. Costs two impulse responses
/// where the finger is neither perfect nor calibrated. Throws as model::ImpulseResponse does.
double modelError(const FingerConfig& config);

/// Of a valid config. Costs five impulse responses where the finger is neither perfect nor calibrated.
/// Throws as model::ImpulseResponse does.
UnseenErrors unseenErrors(const FingerConfig& config);

}  // namespace strainfinger::config
