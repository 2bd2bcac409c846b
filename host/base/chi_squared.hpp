#pragma once
#include <cmath>

namespace strainfinger {

/// Chi-squared that is exceeded as often as a normal variable exceeds `deviations` of its own (Wilson &
/// Hilferty 1931): for 4 degrees of freedom and more to 1 %, beyond 4.5 deviations to 4 %.
inline double chiSquaredQuantile(double degreesOfFreedom, double deviations) {
  const double part = 2 / (9 * degreesOfFreedom);
  return degreesOfFreedom * std::pow(1 - part + deviations * std::sqrt(part), 3);
}

}  // namespace strainfinger
