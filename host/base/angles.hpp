#pragma once
// Files and commands speak of degrees, the model of radians.

#include <numbers>

namespace strainfinger {

inline constexpr double kRadPerDeg = std::numbers::pi / 180;

}  // namespace strainfinger
