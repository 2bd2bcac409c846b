#pragma once
// When a reading is the end of the converter's range, not the finger's strain.

#include <cmath>

#include "host/config/finger_config.hpp"

namespace strainfinger::config {

/// [1] Of full scale. The converter stops at full scale, but strains are less the finger's zero, so a gauge
/// stops as much before or behind full scale as its zero is off. Zeros of simulated fingers are off by 1 % of
/// full scale (standard deviation; SimulatedFinger::kZeroSpread): this is beyond chance, and costs a
/// twentieth of the range, where touches need not be.
inline constexpr double kZeroMargin = 0.05;

/// A gauge that reads so much, of either sign and before its gain, may be at the end of its range.
inline bool isOverRange(const Gauges& gauges, double strain) {
  return std::abs(strain) >= (1 - kZeroMargin) * gauges.full_scale_strain;
}

}  // namespace strainfinger::config
