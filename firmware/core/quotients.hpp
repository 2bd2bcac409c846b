#pragma once
// Quotients that saturate, and what keeps their divisors from being 0: the proof divides by the same code.

#include "firmware/core/packed.hpp"

namespace strainfinger::firmware {

/// numerator / divisor rounded towards 0, of so many bits; 0 if the divisor is none.
template <int Bits>
constexpr Number clippedQuotient(Number numerator, Number divisor) {
  return divisor <= 0 ? Number{0} : clipped<Bits>(numerator / divisor);
}

/// The same with a divisor of either sign, which is not 0.
template <int Bits>
constexpr Number signedQuotient(Number numerator, Number divisor) {
  return clipped<Bits>(numerator / divisor);
}

/// The same number or, if it is even, the next one, so that it may divide.
inline Number nonZero(Number value) { return value | 1; }

}  // namespace strainfinger::firmware
