#pragma once
// When gauges are too far apart for their depth.

#include <numbers>

#include "host/config/finger_config.hpp"

namespace strainfinger::config {

/// Depths of the gauges: in a ring of a larger pitch at the surface a touch between two gauges is seen
/// by both alike whatever its width.
inline constexpr double kSparse = 2;

/// The ring's mean pitch, an arc at the surface, over the gauges' depth by the drawing.
inline double pitchInDepths(const FingerConfig& config) {
  const double outer_m = config.finger.outer_radius_m;
  return 2 * std::numbers::pi * outer_m / config.gauges.count / (outer_m - config.gauges.radius_m);
}

inline bool isSparse(const FingerConfig& config) { return pitchInDepths(config) > kSparse; }

}  // namespace strainfinger::config
