#pragma once
// In place of firmware/core/vector3.hpp: vectors of which only bounds are known, of each number and of the
// length: a product of two is no longer than the product of their lengths, nor is any part of the sums that
// it is made of (Cauchy and Schwarz, Lagrange).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "firmware/core/signal.hpp"

namespace strainfinger::firmware {

inline Number within(double most) {
  const auto limit = static_cast<std::int64_t>(std::ceil(most));
  return {-limit, limit};
}
inline double largest(Number number) {
  return static_cast<double>(std::max(std::abs(number.least()), std::abs(number.most())));
}

class Vector3 {
 public:
  Vector3() = default;
  explicit Vector3(double length) : length_(length) { at_.fill(within(length)); }

  Number& operator[](std::size_t i) { return at_[i]; }
  const Number& operator[](std::size_t i) const { return at_[i]; }
  static std::size_t size() { return 3; }

  /// No more than its numbers allow.
  double length() const {
    const double most = std::hypot(largest(at_[0]), largest(at_[1]), largest(at_[2]));
    return length_ < 0 ? most : std::min(length_, most);
  }

 private:
  std::array<Number, 3> at_;
  double length_ = -1;  ///< below 0: not known
};

struct Unfolded {
  explicit Unfolded(int k)
      : even(static_cast<std::size_t>(absolute(k))), odd(even + kWindowReach), sign((k > 0) - (k < 0)) {}
  std::size_t even, odd;
  std::int64_t sign;
};

/// Of any row that usable() admits; 16 bits each.
struct Columns {
  std::array<Vector3, 2> basis, gradient;
};
inline Columns columnsOf(const FitRow&, const GaugeTriple&) {
  Vector3 column(kWeightLength);
  for (std::size_t i = 0; i < 3; ++i) column[i] = clipped<16>(column[i]);
  return {{column, column}, {column, column}};
}

inline Number inner(const Vector3& a, const Vector3& b) { return within(a.length() * b.length()); }

/// Rounded down: each number by less than 1.
inline Vector3 cross(const Vector3& a, const Vector3& b) {
  const Number whole = within(a.length() * b.length());
  return Vector3(largest(whole) / (1 << 15) + std::sqrt(3.0));
}

inline Vector3 combined(const Vector3& a, const Vector3& b, Pair by) {
  const Number whole = within(a.length() * largest(low(by)) + b.length() * largest(high(by)));
  return Vector3(largest(whole) / (1 << 13) + std::sqrt(3.0));
}

}  // namespace strainfinger::firmware
