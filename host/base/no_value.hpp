#pragma once
// What a table says of a value that isn't known.

#include <limits>

namespace strainfinger {

inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

}  // namespace strainfinger
