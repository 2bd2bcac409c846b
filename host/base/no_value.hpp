#pragma once
// What a table says of a value that isn't known.

#include <cmath>
#include <limits>
#include <optional>

namespace strainfinger {

inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// What a cell of a table says; nothing where it says nothing.
inline std::optional<double> valueOf(double cell) {
  return std::isnan(cell) ? std::nullopt : std::optional(cell);
}

}  // namespace strainfinger
