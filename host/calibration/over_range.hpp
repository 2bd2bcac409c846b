#pragma once
// When a reading is the end of the converter's range, not the finger's strain.

#include "host/config/finger_config.hpp"

namespace strainfinger::calibration {

/// [1] Of full scale. The converter stops at full scale, but strains are less the finger's zero, so a gauge
/// stops as much before or behind full scale as its zero is off. Zeros of simulated fingers are off by 1 % of
/// full scale (standard deviation; SimulatedFinger::kZeroSpread): this is beyond chance, and costs a
/// twentieth of the range, where touches need not be.
inline constexpr double kZeroMargin = 0.05;

/// Of a row whose largest reading, of either sign, is this: a gauge may be at the end of its range.
inline bool isOverRange(const config::Gauges& gauges, double largest_strain) {
  return largest_strain >= (1 - kZeroMargin) * gauges.full_scale_strain;
}

}  // namespace strainfinger::calibration
