#pragma once
// Window fits in the firmware's integers.

#include "common/table_image.hpp"
#include "host/model/impulse_response.hpp"
#include "host/tables/window_fit.hpp"

namespace strainfinger::tables {

/// What the windows see with the contact at each row's offset.
using WindowResponses = std::array<WindowResponse, kFitRows>;
WindowResponses windowResponses(const model::ImpulseResponse& response, int gaugeCount);

/// The largest strain a pressing load of 1 N/m gives a gauge, wherever the contact is.
double peakPerLoad(const WindowResponses& responses);

/// The fits of all rows' offsets, with all gauges or with the best three of each row.
struct WindowFits {
  std::array<WindowFit, kFitRows> refined;
  std::array<std::array<WindowFit, kFitRows>, 2> threePoint;  ///< by FitSense
};

/// Fits per unit of `peak`, for loads within `cone` (largest |tangential| / normal). Throws Failure(kUsage)
/// where no three gauges of a window can tell where the contact is.
WindowFits windowFits(const WindowResponses& responses, double peak, double cone);

/// The largest exponent with which the amplitudes of all rows of all tables fit their 16 bits.
int amplitudeExponent(const WindowFits& fits);

/// Rounds to nearest. A coefficient that doesn't fit its format saturates; amplitudes never do with an
/// exponent of at most amplitudeExponent().
FitTable fitTable(const std::array<WindowFit, kFitRows>& fits, int amplitudeExponent);

}  // namespace strainfinger::tables
