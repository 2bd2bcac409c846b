#pragma once
// Fixed-point numbers to and from real ones: for the host and for constants, not for the sampling path.

#include <limits>

#include "common/fixed.hpp"

namespace strainfinger {

/// 2^exponent, exactly.
constexpr double powerOfTwo(int exponent) {
  double result = 1;
  for (; exponent > 0; --exponent) result *= 2;
  for (; exponent < 0; ++exponent) result /= 2;
  return result;
}

template <typename FixedType>
constexpr double toReal(FixedType value) {
  return static_cast<double>(value.raw()) * powerOfTwo(-FixedType::kFracBits);
}

/// The nearest representable number (halves away from zero), saturating at the ends; NaN gives zero.
template <typename FixedType>
constexpr FixedType fromReal(double value) {
  using Raw = typename FixedType::Raw;
  const double scaled = value * powerOfTwo(FixedType::kFracBits);
  if (!(scaled == scaled)) return FixedType::fromRaw(0);
  if (scaled >= static_cast<double>(std::numeric_limits<Raw>::max())) return FixedType::max();
  if (scaled <= static_cast<double>(std::numeric_limits<Raw>::min())) return FixedType::min();
  return FixedType::fromRaw(static_cast<Raw>(scaled + (scaled < 0 ? -0.5 : 0.5)));
}

}  // namespace strainfinger
