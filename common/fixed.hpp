#pragma once
// Fixed-point numbers as types: a format cannot be mixed up with another, nor with a plain integer.

#include <compare>
#include <concepts>
#include <cstdint>
#include <limits>

namespace strainfinger {

/// A signed or unsigned number with FracBits binary digits after the point, kept in Rep:
/// value = raw * 2^-FracBits. Conversions to and from real numbers are in fixed_real.hpp (never on the
/// sampling path). FracBits may exceed Rep's digits: Fixed<32, int32_t> covers [-0.5, 0.5).
template <int FracBits, std::integral Rep>
class Fixed {
 public:
  using Raw = Rep;
  static constexpr int kFracBits = FracBits;

  constexpr Fixed() = default;
  static constexpr Fixed fromRaw(Rep raw) { return Fixed(raw); }
  static constexpr Fixed max() { return Fixed(std::numeric_limits<Rep>::max()); }
  static constexpr Fixed min() { return Fixed(std::numeric_limits<Rep>::min()); }

  constexpr Rep raw() const { return raw_; }
  constexpr auto operator<=>(const Fixed&) const = default;

 private:
  constexpr explicit Fixed(Rep raw) : raw_(raw) {}
  Rep raw_ = 0;
};

/// Narrows to To, saturating at its ends. Whoever calls it says what becomes of the saturated value.
template <std::integral To, std::integral From>
constexpr To saturate(From value) {
  if (value > std::numeric_limits<To>::max()) return std::numeric_limits<To>::max();
  if (value < std::numeric_limits<To>::min()) return std::numeric_limits<To>::min();
  return static_cast<To>(value);
}

/// Upper half of the 64-bit product, rounded down: one instruction (SMMUL) on a Cortex-M4.
constexpr std::int32_t mulHigh(std::int32_t a, std::int32_t b) {
#if defined(__ARM_ARCH_6M__)
  const std::int32_t aHigh = a >> 16, aLow = a & 0xFFFF, bHigh = b >> 16, bLow = b & 0xFFFF;
  const std::uint32_t low = static_cast<std::uint32_t>(aLow) * static_cast<std::uint32_t>(bLow);
  const std::int32_t middle = aHigh * bLow + static_cast<std::int32_t>(low >> 16);
  return aHigh * bHigh + (middle >> 16) + ((aLow * bHigh + (middle & 0xFFFF)) >> 16);
#else
  return static_cast<std::int32_t>((std::int64_t{a} * b) >> 32);
#endif
}

}  // namespace strainfinger
