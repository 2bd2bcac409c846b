#pragma once
// In place of firmware/core/integers.hpp: bounds of numbers. The firmware's own code, compiled with them,
// notes every operation whose result could leave its word, whatever the inputs.
//
// Code that goes one way or the other by what a number is runs for every way that it could go (choices.hpp),
// and the number knows its way from then on.

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <type_traits>
#include <vector>

#include "common/fixed.hpp"
#include "firmware/core/choices.hpp"

namespace strainfinger::firmware {

/// How many results could leave their word so far.
inline int overflows = 0;

/// Holds products of bounds of 64 bits.
__extension__ typedef __int128 Exact;

/// Bounds of an integer of so many bits.
template <int kBits, bool kSigned>
class Bounds {
 public:
  static constexpr Exact kLeast = kSigned ? -(Exact{1} << (kBits - 1)) : 0;
  static constexpr Exact kMost = (Exact{1} << (kSigned ? kBits - 1 : kBits)) - 1;

  constexpr Bounds() = default;
  template <std::integral Plain>
  constexpr Bounds(Plain number) : Bounds(Exact{number}, Exact{number}) {}
  template <int kOther, bool kOtherSigned>
  requires(kOther < kBits && kSigned) constexpr Bounds(const Bounds<kOther, kOtherSigned>& other)
      : Bounds(other.least(), other.most()) {}
  template <int kOther, bool kOtherSigned>
  requires((kOther >= kBits || !kSigned) &&
           (kOther != kBits ||
            kSigned != kOtherSigned)) constexpr explicit Bounds(const Bounds<kOther, kOtherSigned>& other)
      : Bounds(other.least(), other.most()) {}
  constexpr Bounds(Exact least, Exact most) : least_(least), most_(most) {
    if (least >= kLeast && most <= kMost && least <= most) return;
    ++overflows;
    least_ = std::clamp(least, kLeast, kMost);  // or what follows would overflow here, too
    most_ = std::clamp(most, kLeast, kMost);
  }
  static constexpr Bounds any() { return {kLeast, kMost}; }
  /// A plain number, for what is not proved to go on with: it must fit.
  explicit operator std::uint32_t() const {
    if (least_ < 0 || most_ > 0xFFFFFFFF) ++overflows;
    return static_cast<std::uint32_t>(most_);
  }

  constexpr Exact least() const { return least_; }
  constexpr Exact most() const { return most_; }
  constexpr Exact size() const { return std::max(-least_, most_); }

  /// Knows from now on that it lies there.
  void narrow(Exact least, Exact most) const {
    least_ = std::max(least_, least);
    most_ = std::min(most_, most);
  }
  /// The numbers whose bits this one has, and which are no wider than it, see bitWidth().
  std::vector<const Bounds*> parts;

 private:
  mutable Exact least_ = 0, most_ = 0;
};

using Short = Bounds<16, true>;
using Number = Bounds<32, true>;
using Wide = Bounds<64, true>;
using Natural = Bounds<64, false>;

/// What C++ computes with: shorts as numbers of 32 bits, two of different widths as the wider.
template <typename T>
inline constexpr int kWidth = 8 * static_cast<int>(sizeof(T));
template <int kBits, bool kSigned>
inline constexpr int kWidth<Bounds<kBits, kSigned>> = kBits;
template <typename T>
inline constexpr bool kIsSigned = std::is_signed_v<T>;
template <int kBits, bool kSigned>
inline constexpr bool kIsSigned<Bounds<kBits, kSigned>> = kSigned;
template <typename T>
inline constexpr bool kIsBounds = false;
template <int kBits, bool kSigned>
inline constexpr bool kIsBounds<Bounds<kBits, kSigned>> = true;

/// One of the two has bounds; plain numbers without a sign are never as wide as what they are computed with.
template <typename A, typename B>
concept Computable = (kIsBounds<A> || std::integral<A>)&&(kIsBounds<B> || std::integral<B>)&&(kIsBounds<A> ||
                                                                                              kIsBounds<B>);
template <typename A, typename B>
using Result =
    Bounds<std::max({32, kWidth<A>, kWidth<B>}), (kIsSigned<A> || kWidth<A> < std::max(32, kWidth<B>)) &&
                                                     (kIsSigned<B> || kWidth<B> < std::max(32, kWidth<A>))>;

template <typename T>
constexpr Exact leastOf(const T& number) {
  if constexpr (kIsBounds<T>)
    return number.least();
  else
    return Exact{number};
}
template <typename T>
constexpr Exact mostOf(const T& number) {
  if constexpr (kIsBounds<T>)
    return number.most();
  else
    return Exact{number};
}

template <typename A, typename B>
requires Computable<A, B> Result<A, B>
operator+(const A& a, const B& b) { return {leastOf(a) + leastOf(b), mostOf(a) + mostOf(b)}; }
template <typename A, typename B>
requires Computable<A, B> Result<A, B>
operator-(const A& a, const B& b) { return {leastOf(a) - mostOf(b), mostOf(a) - leastOf(b)}; }
template <typename A, typename B>
requires Computable<A, B>
constexpr Result<A, B> operator*(const A& a, const B& b) {
  const std::array<Exact, 4> ends{leastOf(a) * leastOf(b), leastOf(a) * mostOf(b), mostOf(a) * leastOf(b),
                                  mostOf(a) * mostOf(b)};
  return {*std::min_element(ends.begin(), ends.end()), *std::max_element(ends.begin(), ends.end())};
}
/// Rounded towards 0; of a divisor above 0.
template <typename A, typename B>
requires Computable<A, B> Result<A, B>
operator/(const A& a, const B& b) {
  if (leastOf(b) < 1) ++overflows;
  const Exact least = std::max<Exact>(leastOf(b), 1), most = std::max(mostOf(b), least);
  return {leastOf(a) / (leastOf(a) < 0 ? least : most), mostOf(a) / (mostOf(a) < 0 ? most : least)};
}
template <int kBits, bool kSigned>
constexpr auto operator-(const Bounds<kBits, kSigned>& a) {
  return 0 - a;
}
/// Shifted by bounds of bits, all of the word's.
template <int kBits, bool kSigned, typename By>
requires Computable<Number, By>
constexpr auto operator>>(const Bounds<kBits, kSigned>& a, const By& by) {
  using Shifted = Result<Bounds<kBits, kSigned>, int>;
  if (leastOf(by) < 0 || mostOf(by) >= kWidth<Shifted>) ++overflows;
  const auto down = [](Exact value, Exact bits) {
    return value >> static_cast<int>(std::clamp<Exact>(bits, 0, kWidth<Shifted> - 1));  // or this would, too
  };
  return Shifted(std::min(down(a.least(), leastOf(by)), down(a.least(), mostOf(by))),
                 std::max(down(a.most(), leastOf(by)), down(a.most(), mostOf(by))));
}
template <int kBits, bool kSigned>
constexpr auto operator<<(const Bounds<kBits, kSigned>& a, int by) {
  using Shifted = Result<Bounds<kBits, kSigned>, int>;
  if (by < 0 || by >= kWidth<Shifted>) ++overflows;
  const Exact factor = Exact{1} << std::clamp(by, 0, kWidth<Shifted> - 1);  // or this would overflow, too
  return Shifted(a.least() * factor, a.most() * factor);
}
template <int kBits, bool kSigned, typename B>
constexpr Bounds<kBits, kSigned>& operator+=(Bounds<kBits, kSigned>& a, const B& b) {
  return a = static_cast<Bounds<kBits, kSigned>>(a + b);
}
template <int kBits, bool kSigned, typename B>
constexpr Bounds<kBits, kSigned>& operator-=(Bounds<kBits, kSigned>& a, const B& b) {
  return a = static_cast<Bounds<kBits, kSigned>>(a - b);
}
/// Of numbers that are not negative: no wider than the wider of them, no less than the larger.
template <int kBits, bool kSigned>
constexpr Bounds<kBits, kSigned>& operator|=(Bounds<kBits, kSigned>& a, const Bounds<kBits, kSigned>& b) {
  if (a.least() < 0 || b.least() < 0) ++overflows;
  const auto most = static_cast<std::uint64_t>(std::max(a.most(), b.most()));
  Bounds<kBits, kSigned> both{std::max(a.least(), b.least()), (Exact{1} << std::bit_width(most)) - 1};
  both.parts = a.parts;
  both.parts.insert(both.parts.end(), b.parts.begin(), b.parts.end());
  return a = both;
}

template <typename T>
void narrow(const T& number, Exact least, Exact most) {
  if constexpr (kIsBounds<T>) number.narrow(least, most);
}
template <typename A, typename B>
requires Computable<A, B>
bool operator<(const A& a, const B& b) {
  const bool mayBe = leastOf(a) < mostOf(b), mayNotBe = mostOf(a) >= leastOf(b);
  const bool is = mayBe && (!mayNotBe || choices.of(2) == 0);
  const Exact leastA = leastOf(a), mostA = mostOf(a), leastB = leastOf(b), mostB = mostOf(b);
  if (is) {
    narrow(a, leastA, mostB - 1);
    narrow(b, leastA + 1, mostB);
  } else {
    narrow(a, leastB, mostA);
    narrow(b, leastB, mostA);
  }
  return is;
}
template <typename A, typename B>
requires Computable<A, B>
bool operator>(const A& a, const B& b) { return b < a; }
template <typename A, typename B>
requires Computable<A, B>
bool operator<=(const A& a, const B& b) { return !(b < a); }
template <typename A, typename B>
requires Computable<A, B>
bool operator>=(const A& a, const B& b) { return !(a < b); }
template <typename A, typename B>
requires Computable<A, B>
bool operator==(const A& a, const B& b) {
  const Exact least = std::max(leastOf(a), leastOf(b)), most = std::min(mostOf(a), mostOf(b));
  const bool mayBe = least <= most, mayNotBe = leastOf(a) != mostOf(a) || leastOf(b) != mostOf(b) || !mayBe;
  const bool is = mayBe && (!mayNotBe || choices.of(2) == 0);
  if (is) {
    narrow(a, least, most);
    narrow(b, least, most);
  } else {
    const auto without = [](const auto& number, const auto& other) {
      if (leastOf(other) != mostOf(other)) return;
      if (leastOf(number) == leastOf(other)) narrow(number, leastOf(other) + 1, mostOf(number));
      if (mostOf(number) == leastOf(other)) narrow(number, leastOf(number), leastOf(other) - 1);
    };
    without(a, b);
    without(b, a);
  }
  return is;
}

// What firmware/core/integers.hpp has, see there; primitives/list.hpp holds these against it.

inline std::uint32_t wrapped(const Number&) { return 0; }  // every angle is proved

/// Of each width in turn; the number, and those whose bits it has, are no wider from then on.
template <int kBits, bool kSigned>
int bitWidth(const Bounds<kBits, kSigned>& value) {
  if (value.least() < 0) ++overflows;
  const auto widthOf = [](Exact number) {
    return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(std::max<Exact>(number, 0))));
  };
  const int least = widthOf(value.least()), most = widthOf(value.most());
  const int width = least + choices.of(most - least + 1);
  const Exact end = Exact{1} << width;
  value.narrow(end / 2, end - 1);
  for (const auto* part : value.parts) part->narrow(-end, end - 1);
  return width;
}
template <typename T>
T sizeOf(const T& value) {
  const Exact least = value.least() > 0 ? value.least() : value.most() < 0 ? -value.most() : 0;
  return {least, value.size()};
}
/// Of a number that is kept, its bits are known to be its.
template <typename T>
requires kIsBounds<T> T magnitude(const T& value) {
  T size = sizeOf(value);
  size.parts = {&value};
  return size;
}
template <typename T>
requires(kIsBounds<T> && !std::is_reference_v<T>) T magnitude(T&& value) { return sizeOf(value); }
inline Number signlessBits(Number&& value) {
  const Exact least = value.least() >= 0 ? value.least() : value.most() < 0 ? -value.most() - 1 : 0;
  return {least, std::max(-value.least() - 1, value.most())};
}
inline Number signlessBits(const Number& value) {
  Number bits = signlessBits(Number{value});
  bits.parts = {&value};
  return bits;
}
inline Wide lesser(const Wide& a, const Wide& b) {
  return {std::min(a.least(), b.least()), std::min(a.most(), b.most())};
}
inline Number larger(const Number& a, const Number& b) {
  return {std::max(a.least(), b.least()), std::max(a.most(), b.most())};
}
template <typename T>
Number clamped(const T& value, const Number& low, const Number& high) {
  if (low.most() > high.least()) ++overflows;
  const auto within = [&](Exact number, Exact least, Exact most) {
    return std::min(std::max(number, least), most);
  };
  return {within(leastOf(value), low.least(), high.least()), within(mostOf(value), low.most(), high.most())};
}
/// Both grow with the value; a larger limit lets through more of either sign.
inline Number boundedBy(Exact least, Exact most, const Number& limit) {
  if (limit.least() < 0) ++overflows;
  const auto bounded = [](Exact number, Exact size) { return std::clamp(number, -size, size); };
  return {bounded(least, least < 0 ? limit.most() : limit.least()),
          bounded(most, most < 0 ? limit.least() : limit.most())};
}
template <typename T>
Number limited(const T& value, const Number& limit) {
  return boundedBy(leastOf(value), mostOf(value), limit);
}
template <int bits>
Number scaled(const Number& value, const Number& factor) {
  return static_cast<Number>((Wide{value} * factor) >> bits);
}
template <int bits, int limitBits>
Number narrowed(const Wide& value) {
  return limited(value >> bits, 1 << limitBits);
}
template <int bits>
Number lowBits(const Wide& value) {
  if (value.least() < 0) ++overflows;
  constexpr Exact end = Exact{1} << bits;
  if (value.least() / end == value.most() / end) return {value.least() % end, value.most() % end};
  return {0, end - 1};
}
template <int bits>
Number saturated(const Number& value) {
  constexpr Exact end = Exact{1} << bits;
  return {std::clamp<Exact>(value.least(), -end, end - 1), std::clamp<Exact>(value.most(), -end, end - 1)};
}
inline Short shortened(const Number& value) { return static_cast<Short>(saturated<15>(value)); }
inline Number shifted(const Wide& value, const Number& up, const Number& limit) {
  const auto by = [](Exact number, Exact bits) {
    return bits >= 0 ? number * (Exact{1} << std::min<int>(static_cast<int>(bits), 63))
                     : number >> std::min(-static_cast<int>(bits), 126);
  };
  return boundedBy(std::min(by(value.least(), up.least()), by(value.least(), up.most())),
                   std::max(by(value.most(), up.least()), by(value.most(), up.most())), limit);
}
inline Number mulHigh(const Number& a, const Number& b) { return static_cast<Number>((Wide{a} * b) >> 32); }
inline Wide squareOf(const Number& value) {
  const Number size = sizeOf(value);
  return {size.least() * size.least(), size.most() * size.most()};
}
inline Number dot(const Short* a, const Short* b, int count) {
  if (count % 4 != 0) ++overflows;
  Number sum = 0;
  for (int i = 0; i < count; ++i) sum += a == b ? Number(squareOf(a[i])) : a[i] * b[i];
  return sum;
}

struct Reciprocal {
  Number mantissa = 0;
  Number exponent = 0;
};

/// Of any divisor: what the firmware says of its results.
inline Reciprocal reciprocalOf(const Number& value) {
  if (value.least() < 1) ++overflows;
  return {{(1 << 29) - 4, 1 << 30}, {-60, -30}};
}

inline Number divided(const Number& value, const Reciprocal& by, int bits, const Number& limit) {
  return shifted(Wide{value} * by.mantissa, by.exponent + bits, limit);
}

using strainfinger::saturate;
template <typename To, int kBits, bool kSigned>
requires(kIsBounds<To>) To saturate(const Bounds<kBits, kSigned>& value) {
  return {std::clamp(value.least(), To::kLeast, To::kMost), std::clamp(value.most(), To::kLeast, To::kMost)};
}

}  // namespace strainfinger::firmware
