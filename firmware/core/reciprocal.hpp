#pragma once
// Division by a number that many others are divided by, as multiplications.

#include <bit>
#include <cstdint>

#include "firmware/core/integers.hpp"

namespace strainfinger::firmware {

/// mantissa * 2^exponent: 0, or a mantissa in [2^29 - 4, 2^30] and an exponent in [-60, -30].
struct Reciprocal {
  Number mantissa = 0;
  Number exponent = 0;
};

/// 1 / value for value in [1, 2^31), relative error below 2^-28.
constexpr Reciprocal reciprocalOf(std::int32_t value) {
  const int up = std::countl_zero(static_cast<std::uint32_t>(value)) - 1;
  const auto normal = static_cast<std::uint32_t>(value) << up;             // in [2^30, 2^31)
  const std::uint32_t guess = (~std::uint32_t{0} / (normal >> 15)) << 14;  // 2^61 / normal, to 2^-15
  const std::uint64_t twice = (std::uint64_t{1} << 62) - std::uint64_t{normal} * guess;
  const auto mantissa = static_cast<std::uint32_t>((guess * (twice >> 31)) >> 30);  // one Newton step
  return {static_cast<std::int32_t>(mantissa >> 1), up - 60};
}

/// value * by * 2^bits, rounded down and to the nearest within +-limit.
constexpr Number divided(Number value, const Reciprocal& by, int bits, Number limit) {
  const Wide product = Wide{value} * by.mantissa;
  const int up = by.exponent + bits;
  if (up <= -32) return shifted(static_cast<Number>(product >> 32), up + 32, limit);
  return shifted(product, up, limit);
}

}  // namespace strainfinger::firmware
