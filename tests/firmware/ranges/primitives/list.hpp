// Included with number(), wide(), kept(), whole() and boundsOf() of the firmware's numbers or of bounds.

#include <array>
#include <cmath>

#include "firmware/core/integers.hpp"
#include "tests/firmware/ranges/primitives/primitive.hpp"

namespace strainfinger::firmware {

using ranges::Domain;
using ranges::Interval;

inline std::vector<ranges::Primitive> primitives() {
  const auto sized = [](int bits) { return Domain{1 - std::ldexp(1.0L, bits), std::ldexp(1.0L, bits) - 1}; };
  const auto upTo = [](int bits) { return Domain{0, std::ldexp(1.0L, bits) - 1}; };
  const auto above0 = [](int bits) { return Domain{1, std::ldexp(1.0L, bits) - 1}; };
  const auto plain = [](int least, int most) {
    return Domain{static_cast<long double>(least), static_cast<long double>(most), true};
  };
  using In = const Interval*;
  return {
      {"Number + Number", {sized(30), sized(30)}, [](In a) { return boundsOf(number(a[0]) + number(a[1])); }},
      {"Number - Number", {sized(30), sized(30)}, [](In a) { return boundsOf(number(a[0]) - number(a[1])); }},
      {"- Number", {sized(31)}, [](In a) { return boundsOf(-number(a[0])); }},
      {"Number * Number", {sized(15), sized(15)}, [](In a) { return boundsOf(number(a[0]) * number(a[1])); }},
      {"Short * Short", {sized(15), sized(15)}, [](In a) { return boundsOf(kept(a[0]) * kept(a[1])); }},
      {"Number / above 0",
       {sized(31), above0(31)},
       [](In a) { return boundsOf(number(a[0]) / number(a[1])); }},
      {"Number >> by", {sized(31), plain(0, 31)}, [](In a) { return boundsOf(number(a[0]) >> whole(a[1])); }},
      {"Number << by", {sized(15), plain(0, 16)}, [](In a) { return boundsOf(number(a[0]) << whole(a[1])); }},
      {"Number < Number",
       {sized(2), sized(2)},
       [](In a) {
         auto n = number(a[0]), m = number(a[1]);
         return boundsOf(n < m ? 1 : 0);
       }},
      {"Number == 0",
       {sized(2)},
       [](In a) {
         auto n = number(a[0]);
         return boundsOf(n == 0 ? 1 : 0);
       }},
      {"Wide + Wide", {sized(62), sized(62)}, [](In a) { return boundsOf(wide(a[0]) + wide(a[1])); }},
      {"Wide * Number", {sized(31), sized(31)}, [](In a) { return boundsOf(wide(a[0]) * number(a[1])); }},
      {"Wide >> by", {sized(62), plain(0, 63)}, [](In a) { return boundsOf(wide(a[0]) >> whole(a[1])); }},

      {"bitWidth(Number)",
       {upTo(31)},
       [](In a) {
         auto n = number(a[0]);
         return boundsOf(bitWidth(n));
       }},
      {"bitWidth(Wide)",
       {upTo(62)},
       [](In a) {
         auto n = wide(a[0]);
         return boundsOf(bitWidth(n));
       }},
      {"magnitude", {sized(31)}, [](In a) { return boundsOf(magnitude(number(a[0]))); }},
      {"magnitude of a Wide", {sized(62)}, [](In a) { return boundsOf(magnitude(wide(a[0]))); }},
      {"signlessBits", {sized(31)}, [](In a) { return boundsOf(signlessBits(number(a[0]))); }},
      {"lesser", {sized(62), sized(62)}, [](In a) { return boundsOf(lesser(wide(a[0]), wide(a[1]))); }},
      {"larger", {sized(31), sized(31)}, [](In a) { return boundsOf(larger(number(a[0]), number(a[1]))); }},
      {"clamped",
       {sized(31), plain(-99, 0), plain(0, 99)},
       [](In a) { return boundsOf(clamped(number(a[0]), number(a[1]), number(a[2]))); }},
      {"limited", {sized(31), upTo(30)}, [](In a) { return boundsOf(limited(number(a[0]), number(a[1]))); }},
      {"limited of a Wide",
       {sized(62), upTo(30)},
       [](In a) { return boundsOf(limited(wide(a[0]), number(a[1]))); }},
      {"scaled",
       {sized(31), sized(15)},
       [](In a) { return boundsOf(scaled<16>(number(a[0]), number(a[1]))); }},
      {"narrowed", {sized(62)}, [](In a) { return boundsOf(narrowed<20, 28>(wide(a[0]))); }},
      {"lowBits", {upTo(62)}, [](In a) { return boundsOf(lowBits<10>(wide(a[0]))); }},
      {"saturated", {sized(31)}, [](In a) { return boundsOf(saturated<12>(number(a[0]))); }},
      {"shortened", {sized(31)}, [](In a) { return boundsOf(shortened(number(a[0]))); }},
      {"shifted",
       {sized(31), plain(-70, 70), upTo(28)},
       [](In a) { return boundsOf(shifted(number(a[0]), whole(a[1]), number(a[2]))); }},
      {"shifted of a Wide",
       {sized(62), plain(-70, 70), upTo(28)},
       [](In a) { return boundsOf(shifted(wide(a[0]), whole(a[1]), number(a[2]))); }},
      {"squareOf", {sized(30)}, [](In a) { return boundsOf(squareOf(number(a[0]))); }},
      {"mulHigh", {sized(31), sized(31)}, [](In a) { return boundsOf(mulHigh(number(a[0]), number(a[1]))); }},
      {"dot",
       {sized(13), sized(13), sized(13), sized(13)},
       [](In a) {
         alignas(4) const std::array<Short, 4> left{kept(a[0]), 1, kept(a[1]), 2},
             right{kept(a[2]), -3, kept(a[3]), 4};
         return boundsOf(dot(left.data(), right.data(), 4));
       }},
      {"dot of one",
       {sized(14), sized(14)},
       [](In a) {
         alignas(4) const std::array<Short, 4> both{kept(a[0]), 0, 0, kept(a[1])};
         return boundsOf(dot(both.data(), both.data(), 4));
       }},
      {"mantissa of reciprocalOf",
       {above0(31)},
       [](In a) { return boundsOf(reciprocalOf(number(a[0])).mantissa); },
       false},
      {"exponent of reciprocalOf",
       {above0(31)},
       [](In a) { return boundsOf(reciprocalOf(number(a[0])).exponent); },
       false},
      {"divided",
       {sized(30), above0(31), plain(0, 40), upTo(30)},
       [](In a) {
         return boundsOf(divided(number(a[0]), reciprocalOf(number(a[1])), whole(a[2]), number(a[3])));
       },
       false},
  };
}

}  // namespace strainfinger::firmware
