#pragma once
// Positive real numbers for standard errors.

#include <limits>

#include "firmware/core/integer_root.hpp"
#include "firmware/core/wide.hpp"

namespace strainfinger::firmware {

/// mantissa * 2^exponent. Cheap to multiply, and its root costs one integer root.
struct Scaled {
  Natural mantissa = 0;
  int exponent = 0;
};

/// sqrt(value) rounded down to 16 significant bits, saturating at 2^31 - 1. The mantissa is below 2^63.
[[gnu::noinline]] inline Number root(Scaled value) {
  if (value.mantissa == 0) return 0;
  int up = leadingZeros(value.mantissa);
  if ((value.exponent - up) % 2 != 0) --up;
  const Number digits = Number(integerRoot(lowWord((value.mantissa << up) >> 32)));
  const int exponent = (value.exponent - up + 32) / 2;
  if (exponent <= -32) return 0;
  if (exponent < 0) return digits >> -exponent;
  return exponent > 15 ? std::numeric_limits<std::int32_t>::max() : saturated(Wide{digits} << exponent);
}

/// value as a plain integer, rounded down; saturating at 2^62. The exponent is below 63.
inline Natural plain(Scaled value) {
  if (value.exponent <= 0) return value.exponent > -64 ? value.mantissa >> -value.exponent : 0;
  const int zeros = leadingZeros(value.mantissa);
  return value.exponent < zeros - 1 ? value.mantissa << value.exponent : Natural{1} << 62;
}

/// value with 32 significant bits.
inline Scaled normalised(Natural value) {
  if (value == 0) return {};
  const int up = leadingZeros(value);
  return {(value << up) >> 32, 32 - up};
}

}  // namespace strainfinger::firmware
