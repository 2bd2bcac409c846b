#pragma once
// Pairs of 16-bit numbers, and the products the locator is made of: single instructions on pairs in a word
// where the core has Arm's DSP extension (Cortex-M4), plain C++ with the same results elsewhere.
//
// upperHalves(a, b)   the upper halves of two numbers: divided by 2^16, rounded down
// lowOnly(a)          a pair of which only the low number, of 16 bits, will be looked at
// pairAt(numbers)     two numbers next to each other, the first at a multiple of 4 bytes
// a + b, a - b        number by number; the caller keeps them within 16 bits
// dot(a, b)           a.low * b.low + a.high * b.high, which the caller keeps below 2^31
// lows(a, b)          a.low and b.low; lowAndHigh(a, b): a.low and b.high
// determinant(a, b)   a.low * b.high - a.high * b.low, which the caller keeps below 2^31
// scaledByLow(a, b)   a * b.low / 2^16, rounded down; scaledByHigh(): b.high
// dot(a, b, sum), addScaledByLow(sum, a, b), addScaledByHigh(sum, a, b)    the same, added to a sum

#include <cstddef>
#include <cstdint>
#include <type_traits>

#if defined(__ARM_FEATURE_DSP)
#include <arm_acle.h>
#endif

namespace strainfinger::firmware {

/// What the locator reckons with. The proof that nothing overflows puts intervals in its place
/// (tests/firmware/ranges).
using Number = std::int32_t;

/// One of them that is kept in 16 bits.
using Short = std::int16_t;

/// A number of a table.
constexpr Number tabled(std::int16_t number) { return number; }

/// The i-th of some weights of a column; the proof then knows how long they are together.
template <typename Column>
constexpr Number ofColumn(const Column&, std::size_t, Number weight) {
  return weight;
}

#if defined(__ARM_FEATURE_DSP)

struct Pair {
  std::uint32_t bits;

  bool operator==(const Pair&) const = default;
};

inline std::int32_t low(Pair pair) { return static_cast<std::int16_t>(pair.bits & 0xFFFF); }
inline std::int32_t high(Pair pair) { return static_cast<std::int32_t>(pair.bits) >> 16; }

inline Pair upperHalves(std::int32_t low, std::int32_t high) {
  Pair pair;  // no intrinsic has it, and the compiler doesn't see it
  asm("pkhtb %0, %1, %2, asr #16" : "=r"(pair.bits) : "r"(high), "r"(low));
  return pair;
}
inline Pair lowOnly(std::int32_t number) { return {static_cast<std::uint32_t>(number)}; }
inline Pair pairAt(const std::int16_t* numbers) {
  Pair pair;
  __builtin_memcpy(&pair.bits, __builtin_assume_aligned(numbers, 4), sizeof pair.bits);
  return pair;
}

inline Pair lows(Pair a, Pair b) {
  Pair pair;
  asm("pkhbt %0, %1, %2, lsl #16" : "=r"(pair.bits) : "r"(a.bits), "r"(b.bits));
  return pair;
}
inline Pair lowAndHigh(Pair a, Pair b) {
  Pair pair;
  asm("pkhbt %0, %1, %2" : "=r"(pair.bits) : "r"(a.bits), "r"(b.bits));
  return pair;
}

inline Pair operator+(Pair a, Pair b) {
  return {
      static_cast<std::uint32_t>(__sadd16(static_cast<int16x2_t>(a.bits), static_cast<int16x2_t>(b.bits)))};
}
inline Pair operator-(Pair a, Pair b) {
  return {
      static_cast<std::uint32_t>(__ssub16(static_cast<int16x2_t>(a.bits), static_cast<int16x2_t>(b.bits)))};
}
inline std::int32_t dot(Pair a, Pair b) {
  return __smuad(static_cast<int16x2_t>(a.bits), static_cast<int16x2_t>(b.bits));
}
inline std::int32_t dot(Pair a, Pair b, std::int32_t sum) {
  return __smlad(static_cast<int16x2_t>(a.bits), static_cast<int16x2_t>(b.bits), sum);
}
inline std::int32_t determinant(Pair a, Pair b) {
  return __smusdx(static_cast<int16x2_t>(a.bits), static_cast<int16x2_t>(b.bits));
}
inline std::int32_t scaledByLow(std::int32_t a, Pair b) {
  return __smlawb(a, static_cast<std::int32_t>(b.bits), 0);
}
inline std::int32_t scaledByHigh(std::int32_t a, Pair b) {
  return __smlawt(a, static_cast<std::int32_t>(b.bits), 0);
}
inline std::int32_t addScaledByLow(std::int32_t sum, std::int32_t a, Pair b) {
  return __smlawb(a, static_cast<std::int32_t>(b.bits), sum);
}
inline std::int32_t addScaledByHigh(std::int32_t sum, std::int32_t a, Pair b) {
  return __smlawt(a, static_cast<std::int32_t>(b.bits), sum);
}

#else

/// Cores without packed arithmetic keep the numbers apart.
struct Pair {
  std::int32_t lower;
  std::int32_t upper;

  bool operator==(const Pair&) const = default;
};

inline std::int32_t low(Pair pair) { return pair.lower; }
inline std::int32_t high(Pair pair) { return pair.upper; }

inline Pair upperHalves(std::int32_t low, std::int32_t high) { return {low >> 16, high >> 16}; }
inline Pair lowOnly(std::int32_t number) { return {number, 0}; }
inline Pair pairAt(const std::int16_t* numbers) { return {numbers[0], numbers[1]}; }

inline Pair lows(Pair a, Pair b) { return {a.lower, b.lower}; }
inline Pair lowAndHigh(Pair a, Pair b) { return {a.lower, b.upper}; }

inline Pair operator+(Pair a, Pair b) { return {a.lower + b.lower, a.upper + b.upper}; }
inline Pair operator-(Pair a, Pair b) { return {a.lower - b.lower, a.upper - b.upper}; }
inline std::int32_t dot(Pair a, Pair b) { return a.lower * b.lower + a.upper * b.upper; }
inline std::int32_t dot(Pair a, Pair b, std::int32_t sum) { return sum + dot(a, b); }
inline std::int32_t determinant(Pair a, Pair b) { return a.lower * b.upper - a.upper * b.lower; }

inline std::int32_t scaledBy(std::int32_t a, std::int32_t b) {
  return (a >> 16) * b + (((a & 0xFFFF) * b) >> 16);
}
inline std::int32_t scaledByLow(std::int32_t a, Pair b) { return scaledBy(a, b.lower); }
inline std::int32_t scaledByHigh(std::int32_t a, Pair b) { return scaledBy(a, b.upper); }
inline std::int32_t addScaledByLow(std::int32_t sum, std::int32_t a, Pair b) {
  return sum + scaledByLow(a, b);
}
inline std::int32_t addScaledByHigh(std::int32_t sum, std::int32_t a, Pair b) {
  return sum + scaledByHigh(a, b);
}

#endif

/// The same pointer, about which the compiler knows nothing: loads of two words reach 255 words from it,
/// while from the start of a table whose rows the compiler can number it would take them one by one.
template <typename T>
const T* unknown(const T* pointer) {
  asm("" : "+r"(pointer));
  return pointer;
}

/// The product of a pair's two numbers.
inline std::int32_t productOf(Pair pair) { return low(pair) * high(pair); }

/// |value|; value is not the least of all.
constexpr std::int32_t absolute(std::int32_t value) { return value < 0 ? -value : value; }

/// Of a value of 16 bits.
constexpr Number squareOfShort(Number value) { return value * value; }
constexpr Number atLeast(Number value, Number least) { return value < least ? least : value; }
constexpr Number atMost(Number value, Number most) { return value > most ? most : value; }

/// value^2, exactly. Cores without long products make it of three short ones.
constexpr std::int64_t squareOf(std::int32_t value) {
#if defined(__ARM_ARCH_6M__)
  const std::int32_t upper = value >> 16;
  const std::uint32_t lower = static_cast<std::uint32_t>(value) & 0xFFFF;
  const std::int64_t cross = upper * static_cast<std::int32_t>(lower);
  return (std::int64_t{upper * upper} << 32) + cross * (1 << 17) + lower * lower;
#else
  return std::int64_t{value} * value;
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
