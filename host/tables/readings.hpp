#pragma once
// Strains as the firmware has them once they are conditioned.

#include <algorithm>
#include <cstdint>

#include "common/fixed_real.hpp"
#include "common/table_image.hpp"

namespace strainfinger::tables {

/// A strain as the firmware's conditioning would hand it on: StrainQ32, rounded to nearest, saturating at
/// what the gate's format holds (at least two full scales). NaN gives 0.
inline std::int32_t readingOf(const TableConstants& constants, double strain) {
  const std::int32_t limit = (std::int32_t{1} << (15 + constants.gate_shift)) - 1;
  return std::clamp(fromReal<StrainQ32>(strain).raw(), -limit, limit);
}

}  // namespace strainfinger::tables
