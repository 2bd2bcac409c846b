#pragma once
#include <cmath>
#include <initializer_list>

namespace strainfinger {

/// 1, 2 or 5 times a power of ten, the least that is not below `value`, which is above 0: where a scale ends.
inline double roundScale(double value) {
  const double decade = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0})
    if (value <= step * decade) return step * decade;
  return 10 * decade;
}

}  // namespace strainfinger
