#pragma once
// In place of firmware/core/packed.hpp: numbers of which only bounds are known. The locator's arithmetic,
// compiled with them, notes every operation whose result could leave its word, whatever the inputs.
//
// Bounds alone forget that a projection is no longer than what is projected. So the four pairs of a folded
// column of weights, and those of a signal, know the length they share: a sum of products of pairs, each
// taken once, is at most the product of the lengths (Cauchy and Schwarz).

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "common/fixed.hpp"
#include "common/table_image.hpp"
#include "firmware/core/choices.hpp"

namespace strainfinger::firmware {

/// How many results could leave their word so far.
inline int overflows = 0;

class Number {
 public:
  Number() = default;
  Number(std::int64_t value) : Number(value, value) {}
  Number(std::int64_t least, std::int64_t most, int bits = 32) : least_(least), most_(most) {
    const std::int64_t limit = std::int64_t{1} << (bits - 1);
    if (least < -limit || most >= limit) ++overflows;
  }

  std::int64_t least() const { return least_; }
  std::int64_t most() const { return most_; }

  friend Number operator+(Number a, Number b) { return {a.least_ + b.least_, a.most_ + b.most_}; }
  friend Number operator-(Number a, Number b) { return {a.least_ - b.most_, a.most_ - b.least_}; }
  friend Number operator*(Number a, Number b) { return product(a, b, 0); }
  friend Number operator>>(Number a, int by) {
    if (by < 0 || by > 31) ++overflows;
    return {a.least_ >> by, a.most_ >> by};
  }

  // Goes by what the number is: for each in turn, and the number knows it from then on.
  friend bool operator<=(Number& a, int limit) {
    const bool is = a.most_ <= limit || (a.least_ <= limit && choices.of(2) == 0);
    (is ? a.most_ : a.least_) = is ? std::min<std::int64_t>(a.most_, limit)
                                   : std::max<std::int64_t>(a.least_, std::int64_t{limit} + 1);
    return is;
  }
  friend bool operator==(Number& a, int value) {
    if (a.most_ < value || a.least_ > value) return false;
    const int below = a.least_ < value ? 1 : 0, above = a.most_ > value ? 1 : 0;
    const int side = choices.of(1 + below + above);
    if (side == 0) a.least_ = a.most_ = value;
    if (side == 1 && below != 0) a.most_ = value - 1;
    if (side == 1 + below && above != 0) a.least_ = value + 1;
    return side == 0;
  }

  /// a * b / 2^down, rounded down; what is in between has 64 bits.
  static Number product(Number a, Number b, int down) {
    const auto [least, most] =
        std::minmax({a.least_ * b.least_, a.least_ * b.most_, a.most_ * b.least_, a.most_ * b.most_});
    return {least >> down, most >> down};
  }

  /// A sum of products of pairs: at most `whole`, as long as it takes none of its parts twice.
  static Number partOf(double whole, unsigned parts) {
    const auto most = static_cast<std::int64_t>(std::ceil(whole));
    Number sum(-most, most);
    sum.parts_ = parts;
    return sum;
  }
  unsigned parts() const { return parts_; }

 private:
  std::int64_t least_ = 0, most_ = 0;
  unsigned parts_ = 0;
};

inline Number mulHigh(Number a, Number b) { return Number::product(a, b, 32); }
inline Number tabled(std::int16_t) { return {-32768, 32767}; }

struct Pair {
  Number lower, upper;
  double length = 0;  ///< of all that it is part of; 0: nothing is known of it
  unsigned part = 0;
};

/// Length of a signal, of weights, and what folding makes of a signal's own.
inline const double kSignalLength = std::exp2(14.5);
inline const double kWeightLength = std::sqrt(static_cast<double>(kMostWeightEnergy));
inline const double kFoldedLength = std::sqrt(2.0) * kSignalLength;

inline Number low(Pair pair) { return pair.lower; }
inline Number high(Pair pair) { return pair.upper; }
inline Pair upperHalves(Number low, Number high) {
  return {Number((low >> 16).least(), (low >> 16).most(), 16),
          Number((high >> 16).least(), (high >> 16).most(), 16)};
}
inline Pair lowOnly(Number number) { return {Number(number.least(), number.most(), 16), 0}; }

/// The pairs of the row that is proved. Its weights are those of any row that usable() admits.
inline FitRow provedRow{};
inline Pair pairAt(const std::int16_t* numbers) {
  const Number any = tabled(0);
  const auto offset = static_cast<std::size_t>(reinterpret_cast<const std::byte*>(numbers) -
                                               reinterpret_cast<const std::byte*>(&provedRow));
  if (offset >= offsetof(FitRow, gradient_length)) return {any, any};
  const std::size_t pair = offset % sizeof(FoldedWeights) / (2 * sizeof(std::int16_t));
  return {any, any, kWeightLength, 1u << pair};
}

/// Two numbers are no longer than all that they are part of. One of a pair of which nothing is known has been
/// halved, as the weights are: the difference of two readings is then no longer than they are.
inline Pair lows(Pair a, Pair b) { return {a.lower, b.lower, a.length}; }
inline Pair lowAndHigh(Pair a, Pair b) { return {a.lower, b.upper, a.length}; }
inline Number determinant(Pair a, Pair b) {
  const double lengths = a.length * b.length;
  if (lengths == 0) return a.lower * b.upper - a.upper * b.lower;
  const auto most = static_cast<std::int64_t>(std::ceil(lengths));
  return {-most, most};
}

inline Pair operator+(Pair a, Pair b) {
  const Number lower = a.lower + b.lower, upper = a.upper + b.upper;
  return {Number(lower.least(), lower.most(), 16), Number(upper.least(), upper.most(), 16)};
}
inline Pair operator-(Pair a, Pair b) {
  const Number lower = a.lower - b.lower, upper = a.upper - b.upper;
  return {Number(lower.least(), lower.most(), 16), Number(upper.least(), upper.most(), 16)};
}
inline Number dot(Pair a, Pair b) {
  if (a.length == 0 || b.length == 0) return a.lower * b.lower + a.upper * b.upper;
  const bool energy = a.length == b.length;
  return Number::partOf(energy ? kFoldedLength * kFoldedLength : a.length * b.length, b.part);
}
inline Number dot(Pair a, Pair b, Number sum) {
  const Number product = dot(a, b);
  const bool others = product.parts() != 0 && sum.parts() != 0 && (product.parts() & sum.parts()) == 0;
  if (!others) return sum + product;
  return Number::partOf(static_cast<double>(product.most()), product.parts() | sum.parts());
}
inline Number scaledByLow(Number a, Pair b) { return Number::product(a, b.lower, 16); }
inline Number scaledByHigh(Number a, Pair b) { return Number::product(a, b.upper, 16); }
inline Number addScaledByLow(Number sum, Number a, Pair b) { return sum + scaledByLow(a, b); }
inline Number addScaledByHigh(Number sum, Number a, Pair b) { return sum + scaledByHigh(a, b); }
inline Number productOf(Pair pair) { return pair.lower * pair.upper; }

template <int Bits>
Number clipped(Number value) {
  constexpr std::int64_t kLimit = std::int64_t{1} << (Bits - 1);
  return {std::clamp(value.least(), -kLimit, kLimit - 1), std::clamp(value.most(), -kLimit, kLimit - 1)};
}
/// Whatever the divisor.
template <int Bits>
Number clippedQuotient(Number numerator, Number) {
  const std::int64_t most = std::max(std::abs(numerator.least()), std::abs(numerator.most()));
  const std::int64_t limit = std::min(most, std::int64_t{1} << (Bits - 1));
  return {-limit, std::min(limit, (std::int64_t{1} << (Bits - 1)) - 1)};
}

template <int Bits>
Number signedQuotient(Number numerator, Number divisor) {
  return clippedQuotient<Bits>(numerator, divisor);
}

inline Number nonZero(Number value) { return value; }

constexpr int absolute(int value) { return value < 0 ? -value : value; }

}  // namespace strainfinger::firmware
