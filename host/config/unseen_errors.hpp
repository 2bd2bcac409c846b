#pragma once
// Errors of what is told of a touch that no residual shows.

#include "host/config/finger_config.hpp"

namespace strainfinger::config {

/// Standard errors that all touches of a finger have alike: of what its calibration left, and of how far a
/// finger may be off its model without a trace in the readings. They follow from the model error, which does
/// leave one.
struct UnseenErrors {
  double modelError;  ///< [1] gauges.model_error, or up to twice that where the depths' tolerance asks for it
  double place_m;     ///< an arc of the surface
  double loadScale;   ///< of either load, over it
  double normalShare;  ///< of either load, over the normal load
  double moment_m2;    ///< of the pressure's second moment
};

/// Of a valid config. Costs four impulse responses where the finger is neither perfect nor calibrated. Throws
/// as model::ImpulseResponse does.
UnseenErrors unseenErrors(const FingerConfig& config);

}  // namespace strainfinger::config
