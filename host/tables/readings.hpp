#pragma once
// Strains as the firmware has them once they are conditioned.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/fixed_real.hpp"
#include "common/table_image.hpp"
#include "firmware/core/tangent.hpp"

namespace strainfinger::tables {

/// A strain as the firmware's conditioning would hand it on: StrainQ32, rounded to nearest, saturating at
/// what the gate's format holds (at least two full scales). NaN gives 0.
inline std::int32_t readingOf(const TableConstants& constants, double strain) {
  const std::int32_t limit = (std::int32_t{1} << (15 + constants.gate_shift)) - 1;
  return std::clamp(fromReal<StrainQ32>(strain).raw(), -limit, limit);
}

/// Whether the finger's converter has a strain at a rail, where it may be any beyond.
inline bool isAtRail(const TableImage& image, double strain) {
  constexpr double kMidScale = 0x8000;
  const double code = (strain / image.parameters.full_scale_strain + 1) * kMidScale;
  const int rail = image.constants.adc_rail;
  const double halfStep = (2 * kMidScale - rail) / 2;
  return code < halfStep || code >= rail - halfStep;
}

/// The gauges of a ring that are; `strains` before gains.
inline firmware::GaugeSet gaugesAtRail(const TableImage& image, std::span<const double> strains) {
  firmware::GaugeSet gauges = 0;
  for (std::size_t i = 0; i < strains.size(); ++i)
    if (isAtRail(image, strains[i])) gauges |= firmware::GaugeSet{1} << i;
  return gauges;
}

}  // namespace strainfinger::tables
