#pragma once
// A ring's gains as its tables have them.

#include <vector>

#include "common/table_image.hpp"
#include "host/config/finger_config.hpp"
#include "host/tables/gauge_depths.hpp"

namespace strainfinger::tables {

/// The corrections 1 / gain - 1 in steps of 2^-14. The gain is that of calibration.gain times that of the
/// gauge's depth. All 0 without either. Throws Failure(kUsage) naming a gauge that lies so deep that no
/// correction helps, or whose corrected full scale is more than the firmware holds.
GaugeGains gaugeGains(const config::FingerConfig& config, const DepthFit& depths);

/// What the firmware multiplies the reading of each of `count` gauges with, 1 without a calibration.
std::vector<double> correctionFactors(const GaugeGains& gains, int count);

}  // namespace strainfinger::tables
