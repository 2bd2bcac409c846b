#pragma once
// Two 16-bit numbers in a word, and the products the locator is made of: single instructions where the core
// has Arm's DSP extension (Cortex-M4), plain C++ with the same results elsewhere.

#include <cstdint>
#include <type_traits>

#if defined(__ARM_FEATURE_DSP)
#include <arm_acle.h>
#endif

namespace strainfinger::firmware {

struct Pair {
  std::uint32_t bits;

  constexpr bool operator==(const Pair&) const = default;
};

constexpr std::int32_t low(Pair pair) { return static_cast<std::int16_t>(pair.bits & 0xFFFF); }
constexpr std::int32_t high(Pair pair) { return static_cast<std::int32_t>(pair.bits) >> 16; }

/// Of two numbers' upper halves: what is left of them when divided by 2^16 and rounded down.
inline Pair upperHalves(std::int32_t low, std::int32_t high) {
#if defined(__ARM_FEATURE_DSP)
  Pair pair;  // no intrinsic has it, and the compiler doesn't see it
  asm("pkhtb %0, %1, %2, asr #16" : "=r"(pair.bits) : "r"(high), "r"(low));
  return pair;
#else
  return {static_cast<std::uint32_t>(low) >> 16 | (static_cast<std::uint32_t>(high) & 0xFFFF0000u)};
#endif
}

/// A pair of which only the low number, of 16 bits, will be looked at.
constexpr Pair lowOnly(std::int32_t number) { return {static_cast<std::uint32_t>(number)}; }

/// Two 16-bit numbers next to each other, the first at a multiple of 4 bytes.
inline Pair pairAt(const std::int16_t* numbers) {
  Pair pair;
  __builtin_memcpy(&pair.bits, __builtin_assume_aligned(numbers, 4), sizeof pair.bits);
  return pair;
}

/// The same pointer, about which the compiler knows nothing: loads of two words reach 255 words from it, while
/// from the start of a table whose rows the compiler can number it would take them one by one.
template <typename T>
const T* unknown(const T* pointer) {
  asm("" : "+r"(pointer));
  return pointer;
}

/// Both numbers negated, modulo 2^16.
inline Pair negated(Pair pair) {
#if defined(__ARM_FEATURE_DSP)
  return {static_cast<std::uint32_t>(__ssub16(0, static_cast<int16x2_t>(pair.bits)))};
#else
  return {((0x10000 - pair.bits) & 0xFFFF) | (0u - (pair.bits & 0xFFFF0000u))};
#endif
}

/// sum + a.low * b.low + a.high * b.high, which the caller keeps below 2^31.
inline std::int32_t dot(Pair a, Pair b, std::int32_t sum = 0) {
#if defined(__ARM_FEATURE_DSP)
  return __smlad(static_cast<int16x2_t>(a.bits), static_cast<int16x2_t>(b.bits), sum);
#else
  return sum + low(a) * low(b) + high(a) * high(b);
#endif
}

/// sum + (a * b.low) / 2^16, the product rounded down.
inline std::int32_t addScaledByLow(std::int32_t sum, std::int32_t a, Pair b) {
#if defined(__ARM_FEATURE_DSP)
  return __smlawb(a, static_cast<std::int32_t>(b.bits), sum);
#else
  return sum + (a >> 16) * low(b) + (((a & 0xFFFF) * low(b)) >> 16);
#endif
}
inline std::int32_t addScaledByHigh(std::int32_t sum, std::int32_t a, Pair b) {
#if defined(__ARM_FEATURE_DSP)
  return __smlawt(a, static_cast<std::int32_t>(b.bits), sum);
#else
  return sum + (a >> 16) * high(b) + (((a & 0xFFFF) * high(b)) >> 16);
#endif
}

/// The product of a pair's two numbers.
inline std::int32_t productOf(Pair pair) { return low(pair) * high(pair); }

/// value^2, exactly. Cores without long products make it of three short ones.
constexpr std::uint64_t squareOf(std::int32_t value) {
#if defined(__ARM_ARCH_6M__)
  const std::int32_t upper = value >> 16;
  const std::uint32_t lower = static_cast<std::uint32_t>(value) & 0xFFFF;
  const std::int64_t cross = upper * static_cast<std::int32_t>(lower);
  return (std::uint64_t{static_cast<std::uint32_t>(upper * upper)} << 32) +
         static_cast<std::uint64_t>(cross * (1 << 17)) + lower * lower;
#else
  return static_cast<std::uint64_t>(std::int64_t{value} * value);
#endif
}

/// To the nearest of -2^(Bits-1) .. 2^(Bits-1) - 1.
template <int Bits>
constexpr std::int32_t clipped(std::int32_t value) {
#if defined(__ARM_FEATURE_SAT)
  if (!std::is_constant_evaluated()) return static_cast<std::int32_t>(__builtin_arm_ssat(value, Bits));
#endif
  constexpr std::int32_t kLimit = std::int32_t{1} << (Bits - 1);
  if (value >= kLimit) return kLimit - 1;
  return value < -kLimit ? -kLimit : value;
}

}  // namespace strainfinger::firmware
