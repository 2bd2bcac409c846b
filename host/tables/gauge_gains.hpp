#pragma once
// A ring's gains as its tables have them.

#include <vector>

#include "common/table_image.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::tables {

/// The corrections 1 / gain - 1 of calibration.gain, at the finest exponent that holds them all: rounded to
/// 2^-10 if all are within 12 %, to 2^-8 within 49 %. All 0 without a calibration.
GaugeGains gaugeGains(const config::FingerConfig& config);

/// What the firmware multiplies the reading of each of `count` gauges with, 1 without a calibration.
std::vector<double> correctionFactors(const GaugeGains& gains, int count);

}  // namespace strainfinger::tables
