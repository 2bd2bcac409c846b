#pragma once
// Included with number(), wide(), natural(), whole(), aColumn() and boundsOf() of the firmware's numbers or
// of bounds.

#include <array>
#include <cmath>

#include "firmware/core/integer_root.hpp"
#include "firmware/core/quotients.hpp"
#include "firmware/core/wide.hpp"
#include "tests/firmware/ranges/primitives/primitive.hpp"

namespace strainfinger::firmware {

using ranges::Bounds;
using ranges::Domain;

struct alignas(4) InMemory : std::array<std::int16_t, 2> {};
inline InMemory inMemory(const Bounds* numbers) {
  return {{static_cast<std::int16_t>(numbers[0].least), static_cast<std::int16_t>(numbers[1].least)}};
}

inline std::vector<ranges::Primitive> primitives() {
  const auto of = [](int bits) {
    return Domain{-std::ldexp(1.0L, bits - 1), std::ldexp(1.0L, bits - 1) - 1};
  };
  const auto upTo = [](int bits) { return Domain{0, std::ldexp(1.0L, bits) - 1}; };
  const auto above0 = [](int bits) { return Domain{1, std::ldexp(1.0L, bits) - 1}; };
  const auto below0 = [](int bits) { return Domain{-std::ldexp(1.0L, bits), -1}; };
  const auto sized = [](long double size) { return Domain{-size, size}; };
  const auto shift = [](int most) { return Domain{0, static_cast<long double>(most), true}; };
  using In = const Bounds*;
  static constexpr auto pair = [](In a) { return Pair{number(a[0]), number(a[1])}; };
  return {
      {"Number + Number", {of(31), of(31)}, [](In a) { return boundsOf(number(a[0]) + number(a[1])); }},
      {"Number - Number", {of(31), of(31)}, [](In a) { return boundsOf(number(a[0]) - number(a[1])); }},
      {"Number * Number", {of(16), of(16)}, [](In a) { return boundsOf(number(a[0]) * number(a[1])); }},
      {"Number / above 0", {of(32), above0(31)}, [](In a) { return boundsOf(number(a[0]) / number(a[1])); }},
      {"Number / below 0",
       {sized(0x1p31L - 1), below0(31)},
       [](In a) { return boundsOf(number(a[0]) / number(a[1])); }},
      {"Number >> by", {of(32), shift(31)}, [](In a) { return boundsOf(number(a[0]) >> whole(a[1])); }},
      {"Number <= 0",
       {of(32)},
       [](In a) {
         auto n = number(a[0]);
         return boundsOf(n <= 0 ? 1 : 0);
       }},
      {"Number == 0",
       {sized(2)},
       [](In a) {
         auto n = number(a[0]);
         return boundsOf(n == 0 ? 1 : 0);
       }},
      {"nonZero", {of(32)}, [](In a) { return boundsOf(nonZero(number(a[0]))); }},
      {"clippedQuotient",
       {of(32), of(32)},
       [](In a) { return boundsOf(clippedQuotient<16>(number(a[0]), number(a[1]))); }},
      {"signedQuotient",
       {of(31), above0(31)},
       [](In a) { return boundsOf(signedQuotient<21>(number(a[0]), number(a[1]))); }},
      {"mulHigh", {of(32), of(32)}, [](In a) { return boundsOf(mulHigh(number(a[0]), number(a[1]))); }},

      {"tabled",
       {of(16)},
       [](In a) { return boundsOf(tabled(static_cast<std::int16_t>(a[0].least))); },
       false},
      {"ofColumn", {of(16)}, [](In a) { return boundsOf(ofColumn(aColumn(), 0, number(a[0]))); }},
      {"low(pairAt)",
       {of(16), of(16)},
       [](In a) { return boundsOf(low(pairAt(inMemory(a).data()))); },
       false},
      {"high(pairAt)",
       {of(16), of(16)},
       [](In a) { return boundsOf(high(pairAt(inMemory(a).data()))); },
       false},
      {"low(upperHalves)",
       {of(32), of(32)},
       [](In a) { return boundsOf(low(upperHalves(number(a[0]), number(a[1])))); }},
      {"high(upperHalves)",
       {of(32), of(32)},
       [](In a) { return boundsOf(high(upperHalves(number(a[0]), number(a[1])))); }},
      {"low(lowOnly)", {of(16)}, [](In a) { return boundsOf(low(lowOnly(number(a[0])))); }},
      {"low(lows)",
       {of(16), of(16), of(16), of(16)},
       [](In a) { return boundsOf(low(lows(pair(a), pair(a + 2)))); }},
      {"high(lows)",
       {of(16), of(16), of(16), of(16)},
       [](In a) { return boundsOf(high(lows(pair(a), pair(a + 2)))); }},
      {"low(lowAndHigh)",
       {of(16), of(16), of(16), of(16)},
       [](In a) { return boundsOf(low(lowAndHigh(pair(a), pair(a + 2)))); }},
      {"high(lowAndHigh)",
       {of(16), of(16), of(16), of(16)},
       [](In a) { return boundsOf(high(lowAndHigh(pair(a), pair(a + 2)))); }},
      {"low(Pair + Pair)",
       {of(15), of(15), of(15), of(15)},
       [](In a) { return boundsOf(low(pair(a) + pair(a + 2))); }},
      {"high(Pair + Pair)",
       {of(15), of(15), of(15), of(15)},
       [](In a) { return boundsOf(high(pair(a) + pair(a + 2))); }},
      {"low(Pair - Pair)",
       {of(15), of(15), of(15), of(15)},
       [](In a) { return boundsOf(low(pair(a) - pair(a + 2))); }},
      {"high(Pair - Pair)",
       {of(15), of(15), of(15), of(15)},
       [](In a) { return boundsOf(high(pair(a) - pair(a + 2))); }},
      {"dot",
       {sized(32767), sized(32767), sized(32767), sized(32767)},
       [](In a) { return boundsOf(dot(pair(a), pair(a + 2))); }},
      {"dot and a sum",
       {of(15), of(15), of(15), of(15), of(31)},
       [](In a) { return boundsOf(dot(pair(a), pair(a + 2), number(a[4]))); }},
      {"determinant",
       {sized(32767), sized(32767), sized(32767), sized(32767)},
       [](In a) { return boundsOf(determinant(pair(a), pair(a + 2))); }},
      {"scaledByLow",
       {of(32), of(16), of(16)},
       [](In a) { return boundsOf(scaledByLow(number(a[0]), pair(a + 1))); }},
      {"scaledByHigh",
       {of(32), of(16), of(16)},
       [](In a) { return boundsOf(scaledByHigh(number(a[0]), pair(a + 1))); }},
      {"addScaledByLow",
       {of(32), of(16), of(16), of(31)},
       [](In a) { return boundsOf(addScaledByLow(number(a[3]), number(a[0]), pair(a + 1))); }},
      {"addScaledByHigh",
       {of(32), of(16), of(16), of(31)},
       [](In a) { return boundsOf(addScaledByHigh(number(a[3]), number(a[0]), pair(a + 1))); }},
      {"productOf", {of(16), of(16)}, [](In a) { return boundsOf(productOf(pair(a))); }},
      {"absolute", {sized(0x1p31L - 1)}, [](In a) { return boundsOf(absolute(number(a[0]))); }},
      {"squareOfShort", {of(16)}, [](In a) { return boundsOf(squareOfShort(number(a[0]))); }},
      {"squareOf", {of(32)}, [](In a) { return boundsOf(squareOf(number(a[0]))); }},
      {"atLeast", {of(32), of(32)}, [](In a) { return boundsOf(atLeast(number(a[0]), number(a[1]))); }},
      {"atMost", {of(32), of(32)}, [](In a) { return boundsOf(atMost(number(a[0]), number(a[1]))); }},
      {"clipped<11>", {of(32)}, [](In a) { return boundsOf(clipped<11>(number(a[0]))); }},
      {"clipped<16>", {of(32)}, [](In a) { return boundsOf(clipped<16>(number(a[0]))); }},
      {"clipped<28>", {of(32)}, [](In a) { return boundsOf(clipped<28>(number(a[0]))); }},

      {"Wide + Wide", {of(63), of(63)}, [](In a) { return boundsOf(wide(a[0]) + wide(a[1])); }},
      {"Wide - Wide", {of(63), of(63)}, [](In a) { return boundsOf(wide(a[0]) - wide(a[1])); }},
      {"Wide * Wide", {of(32), of(32)}, [](In a) { return boundsOf(wide(a[0]) * wide(a[1])); }},
      {"Wide / above 0", {of(64), above0(63)}, [](In a) { return boundsOf(wide(a[0]) / wide(a[1])); }},
      {"Wide >> by", {of(64), shift(63)}, [](In a) { return boundsOf(wide(a[0]) >> whole(a[1])); }},
      {"Wide << by", {of(33), shift(31)}, [](In a) { return boundsOf(wide(a[0]) << whole(a[1])); }},
      {"Natural + Natural",
       {upTo(63), upTo(63)},
       [](In a) { return boundsOf(natural(a[0]) + natural(a[1])); }},
      {"Natural * Natural",
       {upTo(32), upTo(32)},
       [](In a) { return boundsOf(natural(a[0]) * natural(a[1])); }},
      {"Natural / above 0",
       {upTo(64), above0(64)},
       [](In a) { return boundsOf(natural(a[0]) / natural(a[1])); }},
      {"Natural >> by", {upTo(64), shift(63)}, [](In a) { return boundsOf(natural(a[0]) >> whole(a[1])); }},
      {"Natural << by", {upTo(33), shift(31)}, [](In a) { return boundsOf(natural(a[0]) << whole(a[1])); }},
      {"Natural == 0",
       {upTo(2)},
       [](In a) {
         auto n = natural(a[0]);
         return boundsOf(n == 0 ? 1 : 0);
       }},
      {"Number(Wide)", {of(32)}, [](In a) { return boundsOf(Number(wide(a[0]))); }},
      {"Wide(Natural)", {upTo(63)}, [](In a) { return boundsOf(Wide(natural(a[0]))); }},
      {"Natural(Number)", {upTo(31)}, [](In a) { return boundsOf(Natural(number(a[0]))); }},
      {"leadingZeros(Natural)",
       {upTo(64)},
       [](In a) {
         auto n = natural(a[0]);
         return boundsOf(leadingZeros(n));
       }},
      {"leadingZeros(Number)",
       {above0(31)},
       [](In a) {
         auto n = number(a[0]);
         return boundsOf(leadingZeros(n));
       }},
      {"shortSquare", {of(16)}, [](In a) { return boundsOf(shortSquare(number(a[0]))); }},
      {"squared", {sized(3037000499.0L)}, [](In a) { return boundsOf(squared(wide(a[0]))); }},
      {"sizeOf", {sized(0x1p63L - 1)}, [](In a) { return boundsOf(sizeOf(wide(a[0]))); }},
      {"larger", {upTo(64), upTo(64)}, [](In a) { return boundsOf(larger(natural(a[0]), natural(a[1]))); }},
      {"positivePart", {of(64)}, [](In a) { return boundsOf(positivePart(wide(a[0]))); }},
      {"noLarger", {of(33)}, [](In a) { return boundsOf(noLarger(wide(a[0]), Natural{1} << 32)); }},
      {"noLonger", {of(32)}, [](In a) { return boundsOf(noLonger(number(a[0]), Natural{1} << 62)); }},
      {"lowWord", {upTo(32)}, [](In a) { return boundsOf(lowWord(natural(a[0]))); }},
      {"integerRoot", {upTo(32)}, [](In a) { return boundsOf(integerRoot(lowWord(natural(a[0])))); }},
      {"lesser", {of(64), of(64)}, [](In a) { return boundsOf(lesser(wide(a[0]), wide(a[1]))); }},
      {"clamped", {of(12)}, [](In a) { return boundsOf(clamped(wide(a[0]), -1000, 900)); }},
      {"limited", {of(12)}, [](In a) { return boundsOf(limited(wide(a[0]), 1000)); }},
      {"saturated", {of(64)}, [](In a) { return boundsOf(saturated(wide(a[0]))); }},
      {"narrowed", {of(64)}, [](In a) { return boundsOf(narrowed(wide(a[0]))); }},
      {"shortened", {of(64)}, [](In a) { return boundsOf(shortened(wide(a[0]))); }},
      {"saturated near its ends", {of(34)}, [](In a) { return boundsOf(saturated(wide(a[0]))); }},
      {"shortened near its ends", {of(18)}, [](In a) { return boundsOf(shortened(wide(a[0]))); }},
  };
}

}  // namespace strainfinger::firmware
