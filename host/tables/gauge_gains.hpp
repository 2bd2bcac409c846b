#pragma once
// A ring's gains as its tables have them.

#include <vector>

#include "common/table_image.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::tables {

/// The corrections 1 / gain - 1, at the finest exponent that holds them all: rounded to 2^-10 if all are
/// within 12 %, to 2^-8 within 49 %. The gain is that of calibration.gain times what
/// calibration.depth_offset_m makes of a gauge's readings. All 0 without either. Throws Failure(kUsage)
/// naming a gauge that lies so deep that no correction helps, and what ImpulseResponse throws. Cost: of
/// depths, an impulse response a gauge.
GaugeGains gaugeGains(const config::FingerConfig& config);

/// What a reading may be off the tables because a gauge's depth is in them as a factor only: its response is
/// also wider or narrower. Standard deviation over the gauges of the largest difference over all angles and
/// both loads, over the largest response; 0 without calibration.depth_offset_m. Throws and costs as
/// gaugeGains().
double depthError(const config::FingerConfig& config);

/// What the firmware multiplies the reading of each of `count` gauges with, 1 without a calibration.
std::vector<double> correctionFactors(const GaugeGains& gains, int count);

}  // namespace strainfinger::tables
