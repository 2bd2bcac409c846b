#pragma once
// The quantities that cross room borders in the firmware, each with its one integer format.

#include <cstdint>

#include "common/fixed.hpp"

namespace strainfinger {

/// Most gauges a ring can have; every array of gauges has this size.
inline constexpr int kMaxGauges = 32;
/// Fewest gauges a ring can have: where one has failed, there are still some more than the eight unknowns of
/// two contacts, so that an answer can be judged.
inline constexpr int kMinGauges = 12;

/// Strain, tensor component, extension positive: [-0.5, 0.5) in steps of 2.3e-10.
using StrainQ32 = Fixed<32, std::int32_t>;

/// Angle as a fraction of a revolution, counter-clockwise seen from the tip: it wraps as angles do.
using TurnQ32 = Fixed<32, std::uint32_t>;

/// Line load [N/m] and its sigma: +-524,288 N/m in steps of 0.24 mN/m.
using LineLoadQ12 = Fixed<12, std::int32_t>;

/// Which strain the gauges read. The numbers are part of the table image.
enum class StrainComponent : std::uint8_t { kRadial = 0, kHoop = 1, kShear = 2 };

}  // namespace strainfinger
