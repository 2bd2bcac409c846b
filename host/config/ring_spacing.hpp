#pragma once
// How far the gauges are apart for their depth and the rubber.

#include <algorithm>

#include "common/table_image.hpp"
#include "host/base/angles.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::config {

/// Depths of the gauges that the widest gap of a dense ring has at most, an arc at the surface: 1.51 on the
/// default finger. From 1.66 on firm touches of narrow contacts were found with a second answer near by.
inline constexpr double kDense = 1.6;
/// The same of a ring that is not sparse: in a wider gap a touch is seen by the gauges on both sides alike,
/// whatever its width.
inline constexpr double kSparse = 2;
/// Poisson's ratio from which on kDense holds: of softer volume, narrow and wide touches read more alike.
inline constexpr double kVolumeKept = 0.48;

/// The widest gap between two gauges at the surface, over the gauges' depth by the drawing.
inline double widestGapInDepths(const FingerConfig& config) {
  const Gauges& gauges = config.gauges;
  double widest_deg = 0;
  for (int gauge = 0; gauge < gauges.count; ++gauge) widest_deg = std::max(widest_deg, gauges.gap_deg(gauge));
  const double outer_m = config.finger.outer_radius_m;
  return widest_deg * kRadPerDeg * outer_m / (outer_m - gauges.radius_m);
}

inline RingSpacing spacingOf(const FingerConfig& config) {
  const double gap = widestGapInDepths(config);
  if (gap > kSparse) return RingSpacing::kSparse;
  return gap <= kDense && config.finger.poisson_ratio >= kVolumeKept ? RingSpacing::kDense
                                                                     : RingSpacing::kLoose;
}

inline bool isSparse(const FingerConfig& config) { return spacingOf(config) == RingSpacing::kSparse; }

}  // namespace strainfinger::config
