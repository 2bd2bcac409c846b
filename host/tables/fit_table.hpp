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

/// The fits of all rows' offsets, and for each the best three gauges.
struct WindowFits {
  std::array<WindowFit, kFitRows> rows;
  std::array<std::array<std::uint8_t, 2>, kFitRows> triples;  ///< numbers in kTripleList, by FitSense
};

/// Fits per unit of `peak`, for loads within `cone` (largest |tangential| / normal). Throws Failure(kUsage)
/// where no three gauges of a window can tell where the contact is.
WindowFits windowFits(const WindowResponses& responses, double peak, double cone);

/// The largest exponent with which the amplitudes of all rows fit their 16 bits.
int amplitudeExponent(const WindowFits& fits);

/// Rounds to nearest. A coefficient that doesn't fit its format saturates; amplitudes never do with an
/// exponent of at most amplitudeExponent().
FitTable fitTable(const WindowFits& fits, int amplitudeExponent);

}  // namespace strainfinger::tables
