#pragma once
// Window fits in the firmware's integers.

#include "common/table_image.hpp"
#include "host/model/impulse_response.hpp"
#include "host/tables/window_fit.hpp"

namespace strainfinger::tables {

/// The fits of all rows' offsets, with all gauges or with the best three of each row.
struct WindowFits {
  std::array<WindowFit, kFitRows> refined;
  std::array<std::array<WindowFit, kFitRows>, 2> threePoint;  ///< by FitSense
};
WindowFits windowFits(const model::ImpulseResponse& response, int gaugeCount, double unit, double cone);

/// The largest exponent with which the amplitudes of all rows of both tables fit their 16 bits.
int amplitudeExponent(const WindowFits& fits);

/// Rounds to nearest. A coefficient that doesn't fit its format saturates; amplitudes never do with an
/// exponent of at most amplitudeExponent().
FitTable fitTable(const std::array<WindowFit, kFitRows>& fits, int amplitudeExponent);

}  // namespace strainfinger::tables
