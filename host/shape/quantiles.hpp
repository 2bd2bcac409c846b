/// How many sigmas bound a normal distribution.
#pragma once

namespace strainfinger::shape {

inline constexpr double kTwoSided95 = 1.959963984540054;
/// One-sided 95 %: also two-sided 90 %.
inline constexpr double kOneSided95 = 1.6448536269514722;

}  // namespace strainfinger::shape
