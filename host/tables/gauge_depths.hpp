#pragma once
// What gauges read that lie deeper or nearer the surface than the drawing says.

#include <array>
#include <vector>

#include "common/table_image.hpp"
#include "host/config/finger_config.hpp"
#include "host/tables/response_table.hpp"

namespace strainfinger::tables {

/// How responses change with a gauge's depth, besides a factor that both loads' have: by so much of the other
/// load's slope over the angle, by a shape of their own that is the same for any width, and, to a tangential
/// load, by so much of themselves.
struct DepthSlopes {
  using Shape = std::array<double, kDepthShapePoints>;  ///< strain per N/m and m
  double normal_turn = 0, tangential_turn = 0;          ///< [rad / m]
  double tangential = 0;                                ///< [1 / m]
  Shape normal_shape{}, tangential_shape{};
};

/// Of each gauge: its readings are `gain` times those of the drawn depth plus `depth_m` times the slopes.
struct DepthFit {
  std::vector<double> gain;     ///< 1 without calibration.depth_offset_m
  std::vector<double> depth_m;  ///< about the offset; empty without any
  DepthSlopes slopes;
  double growth = 0;  ///< by how much the largest response may be larger than the drawn one's, over it
};

/// Least squares over all angles, both loads and widths up to half of the largest one. Throws what
/// ImpulseResponse throws. Cost: of depths, an impulse response a gauge, in all 5 ms.
DepthFit depthFit(const config::FingerConfig& config);

/// As the tables have it; slopes beyond their format are the nearest it holds.
GaugeDepths gaugeDepths(const DepthFit& fit, const ResponseTable& responses);

/// What a reading may be off the tables because they have depths to first order: standard deviation over the
/// gauges of the largest difference over all angles, both loads and widths up to half of the largest one,
/// over the largest response; 0 without depths. Throws and costs as depthFit().
double depthError(const config::FingerConfig& config, const DepthFit& fit, const GaugeDepths& depths,
                  const ResponseTable& responses);

}  // namespace strainfinger::tables
