#pragma once
// In place of firmware/core/wide.hpp: bounds of numbers of 64 bits. What goes by a number's size is run for
// every size it may have (choices.hpp), and knows it from then on.

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <limits>

#include "firmware/core/choices.hpp"
#include "firmware/core/integer_root.hpp"
#include "firmware/core/packed.hpp"

namespace strainfinger::firmware {

class Wide {
 public:
  Wide() = default;
  Wide(Number number) : Wide(number.least(), number.most()) {}
  Wide(int number) : Wide(number, number) {}
  explicit Wide(class Natural);
  Wide(long double least, long double most) : least_(least), most_(most) {
    if (least < -kLimit || most >= kLimit) ++overflows;
  }
  explicit operator Number() const {
    return {static_cast<std::int64_t>(least_), static_cast<std::int64_t>(most_)};
  }

  long double least() const { return least_; }
  long double most() const { return most_; }
  long double size() const { return std::max(std::abs(least_), std::abs(most_)); }
  /// How near to 0.
  long double nearest() const { return least_ > 0 ? least_ : most_ < 0 ? -most_ : 0; }

  friend Wide operator+(Wide a, Wide b) { return {a.least_ + b.least_, a.most_ + b.most_}; }
  friend Wide operator-(Wide a, Wide b) { return {a.least_ - b.most_, a.most_ - b.least_}; }
  friend Wide operator*(Wide a, Wide b) {
    const auto [least, most] =
        std::minmax({a.least_ * b.least_, a.least_ * b.most_, a.most_ * b.least_, a.most_ * b.most_});
    return {least, most};
  }
  /// Rounded towards 0; of a divisor above 0.
  friend Wide operator/(Wide a, Wide b) {
    if (b.least_ < 1) ++overflows;
    const long double divisor = std::max(b.least_, 1.0L), larger = std::max(b.most_, divisor);
    return {std::trunc(a.least_ / (a.least_ < 0 ? divisor : larger)),
            std::trunc(a.most_ / (a.most_ < 0 ? larger : divisor))};
  }
  Wide& operator+=(Wide other) { return *this = *this + other; }
  Wide& operator-=(Wide other) { return *this = *this - other; }
  friend Wide operator>>(Wide a, int by) {
    if (by < 0 || by > 63) ++overflows;
    return {std::floor(std::ldexp(a.least_, -by)), std::floor(std::ldexp(a.most_, -by))};
  }
  friend Wide operator<<(Wide a, int by) {
    if (by < 0 || by > 63) ++overflows;
    return {std::ldexp(a.least_, by), std::ldexp(a.most_, by)};
  }

 private:
  static constexpr long double kLimit = 0x1p63L;
  long double least_ = 0, most_ = 0;
};

class Natural {
 public:
  Natural() = default;
  template <std::integral Integer>
  Natural(Integer number) : Natural(static_cast<long double>(number), static_cast<long double>(number)) {}
  explicit Natural(Number number)
      : Natural(static_cast<long double>(number.least()), static_cast<long double>(number.most())) {}
  Natural(long double least, long double most) : least_(least), most_(most) {
    if (least < 0 || most >= 0x1p64L) ++overflows;
  }

  std::uint64_t least() const { return static_cast<std::uint64_t>(least_); }
  std::uint64_t most() const { return static_cast<std::uint64_t>(most_); }
  void narrow(std::uint64_t least, std::uint64_t most) {
    least_ = std::max(least_, static_cast<long double>(least));
    most_ = std::min(most_, static_cast<long double>(most));
  }

  friend Natural operator+(Natural a, Natural b) { return {a.least_ + b.least_, a.most_ + b.most_}; }
  friend Natural operator*(Natural a, Natural b) { return {a.least_ * b.least_, a.most_ * b.most_}; }
  friend Natural operator/(Natural a, Natural b) {
    if (b.least_ < 1) ++overflows;
    return {std::floor(a.least_ / std::max(b.most_, 1.0L)), std::floor(a.most_ / std::max(b.least_, 1.0L))};
  }
  friend Natural operator>>(Natural a, int by) {
    if (by < 0 || by > 63) ++overflows;
    return {std::floor(std::ldexp(a.least_, -by)), std::floor(std::ldexp(a.most_, -by))};
  }
  friend Natural operator<<(Natural a, int by) {
    if (by < 0 || by > 63) ++overflows;
    return {std::ldexp(a.least_, by), std::ldexp(a.most_, by)};
  }
  Natural& operator+=(Natural other) { return *this = *this + other; }
  /// Of no use but with 0.
  friend bool operator==(Natural& a, int) {
    const bool is = a.most_ == 0 || (a.least_ == 0 && choices.of(2) == 0);
    is ? a.narrow(0, 0) : a.narrow(1, ~std::uint64_t{0});
    return is;
  }

 private:
  long double least_ = 0, most_ = 0;
};

inline Wide::Wide(Natural number)
    : Wide(static_cast<long double>(number.least()), static_cast<long double>(number.most())) {}

inline int leadingZeros(Natural& value) {
  const auto least = static_cast<int>(std::bit_width(value.least()));
  const auto most = static_cast<int>(std::bit_width(value.most()));
  const int bits = least + choices.of(most - least + 1);
  const std::uint64_t below = bits == 0 ? 0 : std::uint64_t{1} << (bits - 1);
  value.narrow(below, bits == 0 ? 0 : below - 1 + below);
  return 64 - bits;
}
inline int leadingZeros(Number& value) {
  Natural natural(value);
  const int zeros = leadingZeros(natural) - 32;
  value = {static_cast<std::int64_t>(natural.least()), static_cast<std::int64_t>(natural.most())};
  return zeros;
}

inline Natural squared(Wide value) {
  if (value.size() * value.size() >= 0x1p63L) ++overflows;
  return {value.nearest() * value.nearest(), value.size() * value.size()};
}
inline Wide squareOf(Number value) { return Wide(squared(value)); }
inline Natural shortSquare(Number value) {
  if (value.least() < -32768 || value.most() > 32767) ++overflows;
  return squared(value);
}
inline Natural sizeOf(Wide value) {
  if (value.size() >= 0x1p63L) ++overflows;
  return {value.nearest(), value.size()};
}
inline Natural larger(Natural a, Natural b) {
  return {static_cast<long double>(std::max(a.least(), b.least())),
          static_cast<long double>(std::max(a.most(), b.most()))};
}
inline Natural positivePart(Wide value) {
  return {std::max(value.least(), 0.0L), std::max(value.most(), 0.0L)};
}
inline Wide noLarger(Wide value, Natural most) {
  const auto limit = static_cast<long double>(most.most());
  return {std::clamp(value.least(), -limit, limit), std::clamp(value.most(), -limit, limit)};
}
inline Number noLonger(Number value, Natural square) {
  const long double length = std::sqrt(static_cast<long double>(square.most()));
  const auto limit = static_cast<std::int64_t>(length);
  const Number known = value.within(-limit, limit);
  if (value.parts() == 0) return known;
  return Number::component(known, std::nextafter(static_cast<double>(length), 0x1p64), value.parts());
}
inline Natural lowWord(Natural value) {
  if (value.most() >> 32 != 0) ++overflows;
  return value;
}
inline Number integerRoot(Natural value) {
  return {integerRoot(static_cast<std::uint32_t>(value.least())),
          integerRoot(static_cast<std::uint32_t>(value.most()))};
}
inline Wide lesser(Wide a, Wide b) { return {std::min(a.least(), b.least()), std::min(a.most(), b.most())}; }
inline Wide clamped(Wide value, Wide least, Wide most) {
  return {std::clamp(value.least(), least.least(), most.most()),
          std::clamp(value.most(), least.least(), most.most())};
}
inline Wide limited(Wide value, Wide most) { return clamped(value, Wide{0} - most, most); }
inline Number saturated(Wide value) {
  constexpr long double kLeast = std::numeric_limits<std::int32_t>::min();
  constexpr long double kMost = std::numeric_limits<std::int32_t>::max();
  return static_cast<Number>(
      Wide(std::clamp(value.least(), kLeast, kMost), std::clamp(value.most(), kLeast, kMost)));
}
inline Number narrowed(Wide value) { return saturated(value); }
inline Short shortened(Wide value) { return clipped<16>(saturated(value)); }

}  // namespace strainfinger::firmware
