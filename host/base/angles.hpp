#pragma once
// Files and commands speak of degrees, the model of radians.

#include <cmath>
#include <numbers>

namespace strainfinger {

inline constexpr double kRadPerDeg = std::numbers::pi / 180;

/// The same direction, 0 or more and below 360; NaN of NaN.
inline double withinATurn_deg(double angle_deg) {
  const double rest_deg = std::fmod(angle_deg, 360);
  if (rest_deg >= 0) return std::abs(rest_deg);  // no -0, which would be printed
  const double turned_deg = rest_deg + 360;
  return turned_deg == 360 ? 0 : turned_deg;  // of what is too little below 0 to be seen beside 360
}

/// A direction in degrees: 0 or more and below 360.
inline double degreesOf(double angle_rad) { return withinATurn_deg(angle_rad / kRadPerDeg); }

/// To an angle the short way round, -pi to pi.
inline double shortWay_rad(double angle_rad, double from_rad) {
  return std::remainder(angle_rad - from_rad, 2 * std::numbers::pi);
}

}  // namespace strainfinger
