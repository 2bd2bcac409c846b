#pragma once
// Conversions from the fit's units to those of contacts, and from those to the integers of CAN frames; roots.

#include <algorithm>
#include <bit>
#include <cstdint>

#include "firmware/core/integers.hpp"

namespace strainfinger::firmware {

/// amplitude * scale * 2^exponent [LineLoadQ12], rounded to nearest, saturating. The exponent is below 0: see
/// usableLoads().
inline Number lineLoad(Number amplitude, Number scale, int exponent) {
  if (exponent <= -63) return 0;
  return saturate<Number>((Wide{amplitude} * scale + (Wide{1} << (-exponent - 1))) >> -exponent);
}

/// An angle [revolutions * 2^32] in hundredths of a degree, 0 .. 36000, rounded to nearest.
inline Number centidegrees(Natural turns_q32) {
  return Number((turns_q32 * 36000 + (Natural{1} << 31)) >> 32);
}

/// A difference of angles [revolutions * 2^32] in degrees, rounded to nearest.
inline Number wholeDegrees(Number turns_q32) {
  return Number((Wide{turns_q32} * 360 + (Wide{1} << 31)) >> 32);
}

/// Force of a line load [mN * 2^halvings], rounded to nearest; `perLoad_q16` [mN per N/m * 2^16] of 32 bits.
inline Wide force(Wide perLoad_q16, Number load_q12, int halvings) {
  const int down = 16 + 12 - halvings;
  return (Wide{load_q12} * perLoad_q16 + (Wide{1} << (down - 1))) >> down;
}

/// Square root, rounded down, by at most five Newton steps from above.
constexpr std::uint32_t integerRoot(std::uint32_t value) {
  if (value == 0) return 0;
  std::uint32_t root = 1u << ((33 - std::countl_zero(value)) / 2);
  while (true) {
    const std::uint32_t next = (root + value / root) / 2;
    if (next >= root) return root;
    root = next;
  }
}

/// A positive number, mantissa * 2^exponent with the mantissa's highest bit set; or 0.
struct Floating {
  std::uint32_t mantissa = 0;
  int exponent = 0;
};

constexpr Floating floatingOf(std::uint64_t value) {
  if (value == 0) return {};
  const int up = std::countl_zero(value);
  return {static_cast<std::uint32_t>(value << up >> 32), 32 - up};
}

/// A square root, rounded down: mantissa * 2^exponent with the mantissa's highest bit set; or 0.
struct Root {
  std::uint16_t mantissa = 0;
  std::int16_t exponent = 0;
};

/// Relative error below 2^-15. Exponents within +-2^15.
constexpr Root rootOf(const Floating& number) {
  const int odd = number.exponent & 1;
  return {static_cast<std::uint16_t>(integerRoot(number.mantissa >> odd)),
          static_cast<std::int16_t>((number.exponent + odd) / 2)};
}

/// mantissa * 2^exponent as an integer, rounded down, at most `most`, which is below 2^45. The mantissa is 0
/// or at least 2^15.
constexpr std::int64_t integerOf(std::uint32_t mantissa, int exponent, std::int64_t most) {
  if (mantissa == 0) return 0;
  if (exponent <= 0) return std::min<std::int64_t>(exponent <= -32 ? 0 : mantissa >> -exponent, most);
  return exponent > 30 ? most : std::min<std::int64_t>(static_cast<std::int64_t>(mantissa) << exponent, most);
}

}  // namespace strainfinger::firmware
