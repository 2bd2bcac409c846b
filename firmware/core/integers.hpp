#pragma once
// The integer types and operations of the estimator. The proof that nothing overflows replaces the integers
// by intervals (tests/firmware/ranges).

#include <algorithm>
#include <bit>
#include <cstdint>

#include "common/fixed.hpp"

#if defined(__ARM_FEATURE_DSP)
#include <arm_acle.h>
#endif

namespace strainfinger::firmware {

using Short = std::int16_t;  ///< for storage only: sums and products are computed as Number or Wide
using Number = std::int32_t;
using Wide = std::int64_t;
using Natural = std::uint64_t;

constexpr Number magnitude(Number value) { return value < 0 ? -value : value; }
constexpr Wide magnitude(Wide value) { return value < 0 ? -value : value; }

/// A change of angle [turns * 2^32] as an unsigned number, because angles wrap.
constexpr std::uint32_t wrapped(Number turns_q32) { return static_cast<std::uint32_t>(turns_q32); }

/// Number of bits of a value that is not negative.
constexpr int bitWidth(Number value) {
  return static_cast<int>(std::bit_width(static_cast<std::uint32_t>(value)));
}
constexpr int bitWidth(Wide value) {
  return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(value)));
}

/// The value or, if it is negative, ~value: its magnitude to within 1, and the lowest number can't overflow.
constexpr Number signlessBits(Number value) { return value < 0 ? ~value : value; }

constexpr Wide lesser(Wide a, Wide b) { return std::min(a, b); }
constexpr Number larger(Number a, Number b) { return std::max(a, b); }
constexpr Number clamped(Number value, Number low, Number high) { return std::clamp(value, low, high); }
constexpr Number limited(Number value, Number limit) { return std::clamp(value, -limit, limit); }
constexpr Number limited(Wide value, Number limit) {
  return static_cast<Number>(std::clamp<Wide>(value, -limit, limit));
}

/// value * factor / 2^bits, rounded down; the caller keeps the result within 32 bits.
template <int bits>
constexpr Number scaled(Number value, Number factor) {
  return static_cast<Number>((Wide{value} * factor) >> bits);
}

/// value / 2^bits, rounded down, then clamped to +-2^limitBits.
template <int bits, int limitBits>
constexpr Number narrowed(Wide value) {
  static_assert(bits <= 32 && bits + limitBits >= 32 && limitBits < 31);
  constexpr Number most = Number{1} << (bits + limitBits - 32);
  const auto upper = static_cast<Number>(value >> 32);
  if (upper >= most) return Number{1} << limitBits;
  if (upper < -most) return -(Number{1} << limitBits);
  return static_cast<Number>(value >> bits);
}

/// The bits that value >> bits drops, of a value that is not negative.
template <int bits>
constexpr Number lowBits(Wide value) {
  return static_cast<Number>(value & ((Wide{1} << bits) - 1));
}

/// Clamps to -2^bits .. 2^bits - 1.
template <int bits>
inline Number saturated(Number value) {
#if defined(__ARM_FEATURE_SAT)
  return static_cast<Number>(__builtin_arm_ssat(value, bits + 1));  // GCC 12 warns about __ssat()
#else
  return std::clamp<Number>(value, -(1 << bits), (1 << bits) - 1);
#endif
}

/// Clamps to 16 bits.
inline Short shortened(Number value) { return static_cast<Short>(saturated<15>(value)); }

/// value * 2^up, where `up` may be negative, rounded down and clamped to +-limit.
constexpr Number shifted(Wide value, int up, Number limit) {
  if (up <= 0) return limited(value >> std::min(-up, 63), limit);
  const Wide most = Wide{limit} >> std::min(up, 62);
  if (value > most) return limit;
  if (value < -most) return -limit;
  return static_cast<Number>(value << std::min(up, 62));  // only a 0 is shifted by more
}

constexpr Number shifted(Number value, int up, Number limit) {
  if (up <= 0) return limited(value >> std::min(-up, 31), limit);
  const Number most = limit >> std::min(up, 31);
  if (value > most) return limit;
  if (value < -most) return -limit;
  return value << std::min(up, 31);  // only a 0 is shifted by more
}

/// value^2, exactly. Cores without products of 64 bits make it of three products of 32 bits.
constexpr Wide squareOf(Number value) {
#if defined(__ARM_ARCH_6M__)
  const std::int32_t upper = value >> 16;
  const std::uint32_t lower = static_cast<std::uint32_t>(value) & 0xFFFF;
  const std::int64_t cross = upper * static_cast<std::int32_t>(lower);
  return (std::int64_t{upper * upper} << 32) + cross * (1 << 17) + lower * lower;
#else
  return Wide{value} * value;
#endif
}

/// Sum of a[i] * b[i]. `count` is a multiple of 4 and both arrays start at multiples of 4 bytes, so that
/// cores with Arm's DSP extension compute two products with one instruction. The caller keeps the sum within
/// 32 bits.
inline Number dot(const Short* a, const Short* b, int count) {
  Number sum = 0;
#if defined(__ARM_FEATURE_DSP)
  for (const Short* const end = a + count; a != end; a += 4, b += 4) {
    int16x2_t a1, a2, b1, b2;
    __builtin_memcpy(&a1, a, sizeof a1);
    __builtin_memcpy(&a2, a + 2, sizeof a2);
    __builtin_memcpy(&b1, b, sizeof b1);
    __builtin_memcpy(&b2, b + 2, sizeof b2);
    sum = __smlad(a2, b2, __smlad(a1, b1, sum));
  }
#else
  for (int i = 0; i < count; ++i) sum += a[i] * b[i];
#endif
  return sum;
}

/// 1 / divisor as mantissa * 2^exponent, for several divisions by the same number. Either 0, or the mantissa
/// is in [2^29 - 4, 2^30] and the exponent in [-60, -30].
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

/// value * by * 2^bits, rounded down and clamped to +-limit.
constexpr Number divided(Number value, const Reciprocal& by, int bits, Number limit) {
  const Wide product = Wide{value} * by.mantissa;
  const int up = by.exponent + bits;
  if (up <= -32) return shifted(static_cast<Number>(product >> 32), up + 32, limit);
  return shifted(product, up, limit);
}

}  // namespace strainfinger::firmware
