#pragma once
// In place of firmware/core/packed.hpp: numbers of which only bounds are known. The locator's arithmetic,
// compiled with them, notes every operation whose result could leave its word, whatever the inputs.
//
// Bounds alone forget that a projection is no longer than what is projected. So the four pairs of a folded
// column of weights, and those of a signal, know the length they share: a sum of products of pairs, each
// taken once, is at most the product of the lengths (Cauchy and Schwarz). So do single numbers of a vector,
// and so is each number of a cross product of two (Lagrange).

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "common/fixed.hpp"
#include "common/table_image.hpp"
#include "firmware/core/choices.hpp"

namespace strainfinger::firmware {

/// How many results could leave their word so far.
inline int overflows = 0;

/// Which vector a number is of. What is made of vectors in the same way has the same name; 0 has none.
using Name = std::uint64_t;
constexpr Name named(char how, Name a, Name b = 1) {
  if (a == 0 || b == 0) return 0;
  constexpr Name kOdd = 0x9E3779B97F4A7C15;
  return (((a * kOdd) ^ b) * kOdd ^ static_cast<Name>(how)) * kOdd;
}

class Number {
 public:
  Number() = default;
  Number(std::int64_t value) : Number(value, value) {}
  Number(std::int64_t least, std::int64_t most, int bits = 32) : least_(least), most_(most) {
    const std::int64_t limit = std::int64_t{1} << (bits - 1);
    if (least >= -limit && most < limit) return;
    ++overflows;
    least_ = std::clamp(least, -limit, limit - 1);  // or what follows would overflow here, too
    most_ = std::clamp(most, -limit, limit - 1);
  }

  std::int64_t least() const { return least_; }
  std::int64_t most() const { return most_; }

  friend Number operator+(Number a, Number b) {
    if (a.isZero()) return b;
    const std::int64_t least = a.least_ + b.least_, most = a.most_ + b.most_;
    if (a.sumsWith(b)) return sumOf(least, most, a.whole_, a.parts_ | b.parts_, a.rounding_, a.of_);
    if (a.isBeside(b)) return someOf(least, most, a, b);
    if (a.isLike(b))
      return component({least, most}, a.length_ + b.length_, a.parts_, named('+', a.of_, b.of_));
    return {least, most};
  }
  friend Number operator-(Number a, Number b) {
    const std::int64_t least = a.least_ - b.most_, most = a.most_ - b.least_;
    if (a.isMinorWith(b)) return crossed(least, most, a);
    return {least, most};
  }
  friend Number operator*(Number a, Number b) {
    const auto [least, most] = products(a, b);
    if (a.isComponent() && b.isComponent()) {
      const double whole = a.length_ * b.length_;
      if (a.parts_ == b.parts_) return sumOf(least, most, whole, a.parts_, 0, named('.', a.of_, b.of_));
      return minor(least, most, whole, a, b);
    }
    if (!a.isComponent()) return {least, most};
    return component({least, most}, a.length_ * static_cast<double>(b.size()), a.parts_, named('*', a.of_));
  }
  /// Rounded towards 0; of a divisor that is on one side of it.
  friend Number operator/(Number a, Number b) {
    if (b.least_ <= 0 && b.most_ >= 0) {
      ++overflows;
      return {-a.size(), a.size()};
    }
    const auto [least, most] =
        std::minmax({a.least_ / b.least_, a.least_ / b.most_, a.most_ / b.least_, a.most_ / b.most_});
    if (!a.isComponent()) return {least, most};
    const auto divisor = static_cast<double>(std::min(std::abs(b.least_), std::abs(b.most_)));
    return component({least, most}, a.length_ / divisor, a.parts_, named('/', a.of_));
  }
  friend Number operator>>(Number a, int by) {
    if (by < 0 || by > 31) ++overflows;
    const std::int64_t least = a.least_ >> by, most = a.most_ >> by;
    if (a.whole_ > 0)
      return sumOf(least, most, std::ldexp(a.whole_, -by), a.parts_, std::ldexp(a.rounding_, -by) + 1, a.of_);
    if (!a.isComponent()) return {least, most};
    return component({least, most}, std::ldexp(a.length_, -by) + std::sqrt(double{kMaxGauges}), a.parts_,
                     named('>', a.of_));
  }
  /// Of the last bit alone, which makes it odd: of either sign in turn.
  friend Number operator|(Number a, int bit) {
    if (bit != 1) ++overflows;
    const bool isNegative = a.most_ < 0 || (a.least_ < 0 && choices.of(2) == 0);
    if (isNegative) return {a.least_ | 1, std::min<std::int64_t>(a.most_ | 1, -1)};
    return {std::max<std::int64_t>(a.least_, 0) | 1, a.most_ | 1};
  }
  Number& operator+=(Number other) { return *this = *this + other; }
  Number& operator-=(Number other) { return *this = *this - other; }

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
    const auto [least, most] = products(a, b);
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

  /// One of the numbers of a vector no longer than that. A sum of products of two such vectors' numbers is as
  /// one of pairs. What is done with one number must be done with all of its vector, and no other vectors of
  /// these lengths may come into the sum: the test that says `component` sees to it.
  /// Of a vector with a name, also sums of its numbers are known, and of a cross product what its numbers
  /// are.
  static Number component(Number any, double length, unsigned part, Name of = 0) {
    any.parts_ = part;
    any.length_ = length;
    any.of_ = of;
    return any;
  }
  double length() const { return length_; }
  /// With other bounds, which are nearer to 0 and on either side of it.
  Number within(std::int64_t least, std::int64_t most) const {
    if (least > 0 || most < 0) ++overflows;
    Number nearer = *this;
    nearer.least_ = std::clamp(least_, least, most);
    nearer.most_ = std::clamp(most_, least, most);
    return nearer;
  }
  std::int64_t size() const { return std::max(std::abs(least_), std::abs(most_)); }

 private:
  /// A product of two vectors' numbers at different places, of which a cross product is made.
  static Number minor(std::int64_t least, std::int64_t most, double whole, const Number& a, const Number& b) {
    Number product = component({least, most}, whole, 0, named('x', a.of_, b.of_));
    product.left_ = static_cast<std::uint8_t>(a.parts_);
    product.right_ = static_cast<std::uint8_t>(b.parts_);
    return product;
  }
  bool isMinorWith(const Number& other) const {
    return left_ != 0 && left_ == other.right_ && right_ == other.left_ && of_ != 0 && of_ == other.of_ &&
           length_ == other.length_;
  }
  static Number crossed(std::int64_t least, std::int64_t most, const Number& a) {
    const auto limit = static_cast<std::int64_t>(std::ceil(a.length_));
    return component({std::max(least, -limit), std::min(most, limit)}, a.length_, 7u ^ a.left_ ^ a.right_,
                     a.of_);
  }
  /// The sum of some numbers of one vector: no more than as many equal ones would be.
  static Number someOf(std::int64_t least, std::int64_t most, const Number& a, const Number& b) {
    const unsigned parts = a.parts_ | b.parts_;
    const auto limit = static_cast<std::int64_t>(std::ceil(a.length_ * std::sqrt(std::popcount(parts))));
    return component({std::max(least, -limit), std::min(most, limit)}, a.length_, parts, a.of_);
  }
  bool isComponent() const { return length_ > 0 && std::has_single_bit(parts_); }
  bool isBeside(const Number& other) const {
    return length_ > 0 && of_ != 0 && of_ == other.of_ && length_ == other.length_ && parts_ != 0 &&
           (parts_ & other.parts_) == 0;
  }
  bool isLike(const Number& other) const {
    return isComponent() && other.isComponent() && parts_ == other.parts_;
  }
  static std::pair<std::int64_t, std::int64_t> products(const Number& a, const Number& b) {
    return std::minmax({a.least_ * b.least_, a.least_ * b.most_, a.most_ * b.least_, a.most_ * b.most_});
  }
  /// Of products of numbers, each rounded by no more than that, within bounds of their own.
  static Number sumOf(std::int64_t least, std::int64_t most, double whole, unsigned parts, double rounding,
                      Name of) {
    const auto limit = static_cast<std::int64_t>(std::ceil(whole + rounding * std::popcount(parts)));
    Number sum(std::clamp(least, -limit, limit), std::clamp(most, -limit, limit));
    sum.parts_ = parts;
    sum.whole_ = whole;
    sum.rounding_ = rounding;
    sum.of_ = of;
    return sum;
  }
  bool isZero() const { return least_ == 0 && most_ == 0; }
  bool sumsWith(const Number& other) const {
    return whole_ > 0 && whole_ == other.whole_ && rounding_ == other.rounding_ && of_ == other.of_ &&
           (parts_ & other.parts_) == 0;
  }

  std::int64_t least_ = 0, most_ = 0;
  unsigned parts_ = 0;
  double whole_ = 0, rounding_ = 0;    ///< of a sum of products
  double length_ = 0;                  ///< of the vector that it is a component of; 0: of none
  Name of_ = 0;                        ///< .. and that vector, or both of the product
  std::uint8_t left_ = 0, right_ = 0;  ///< of two vectors' numbers at different places: at which
};

/// Kept in 16 bits.
class Short : public Number {
 public:
  Short() = default;
  Short(Number number) : Number(number) {
    if (number.least() < -32768 || number.most() > 32767) ++overflows;
  }
};

inline Number squareOfShort(Number value) {
  if (value.least() < -32768 || value.most() > 32767) ++overflows;
  const Number square = value * value;
  return square.within(0, square.most());
}
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

/// The rows and weights that are proved, any that usable() admits, and their lengths.
inline FitRow provedRow{};
inline std::array<NearRow, 3> provedNear{};
inline StartWeights provedStart{};
inline const double kNearLength = std::sqrt(static_cast<double>(kMostNearEnergy));

/// Numbers of a table from its start on; none of another one.
template <typename Table>
std::size_t numbersInto(const Table& table, const std::int16_t* numbers) {
  return (reinterpret_cast<std::uintptr_t>(numbers) - reinterpret_cast<std::uintptr_t>(&table)) /
         sizeof(std::int16_t);
}

/// Each pair is that part of a column which goes with the same part of a signal.
inline Pair pairAt(const std::int16_t* numbers) {
  const Number any = tabled(0);
  if (const auto at = numbersInto(provedRow, numbers); at < offsetof(FitRow, gradient_length) / 2)
    return {any, any, kWeightLength, 1u << (at % (sizeof(FoldedWeights) / 2) / 2)};
  constexpr unsigned kFirstEven = 1, kFirstOdd = 4, kSecondOdd = 8;
  if (const auto at = numbersInto(provedStart, numbers); at < provedStart.size())
    return {any, any, kWeightLength, at == 0 ? kFirstOdd : kSecondOdd};
  if (const auto at = numbersInto(provedNear, numbers); at < sizeof provedNear / 2) {
    const std::size_t inRow = at % (sizeof(NearRow) / 2);
    return {any, any, kNearLength, inRow == 0 ? kFirstEven : inRow == 2 ? kFirstOdd : 0};
  }
  return {any, any};
}

/// Three numbers of a column of a row.
template <typename Column>
Number ofColumn(const Column& column, std::size_t i, Number weight) {
  const std::size_t at = numbersInto(provedRow, column.data());
  if (at >= offsetof(FitRow, gradient_length) / 2) ++overflows;
  return Number::component(weight, kWeightLength, 1u << i, at + 1);
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
  return value.within(-kLimit, kLimit - 1);
}
inline Number atLeast(Number value, Number least) {
  return {std::max(value.least(), least.least()), std::max(value.most(), least.most())};
}
inline Number atMost(Number value, Number most) {
  return {std::min(value.least(), most.least()), std::min(value.most(), most.most())};
}

constexpr int absolute(int value) { return value < 0 ? -value : value; }
inline Number absolute(Number value) {
  const std::int64_t least = value.least() > 0 ? value.least() : value.most() < 0 ? -value.most() : 0;
  return {least, value.size()};
}

}  // namespace strainfinger::firmware
