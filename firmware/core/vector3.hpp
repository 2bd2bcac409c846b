#pragma once
// Three readings of a window, or three weights of a column, and the products of such vectors.

#include <array>
#include <cstddef>

#include "firmware/core/signal.hpp"

namespace strainfinger::firmware {

using Vector3 = std::array<Number, 3>;

/// Where a gauge is in what was folded: at signed distance k from the middle, its part of a sum and of a
/// difference, of which the middle gauge has none.
struct Unfolded {
  explicit Unfolded(int k)
      : even(static_cast<std::size_t>(absolute(k))), odd(even + kWindowReach), sign((k > 0) - (k < 0)) {}

  std::size_t even, odd;
  std::int32_t sign;
};

/// A row's weights [* 2^15] of three gauges, which folding halved. What rounding made longer than 1 is
/// clipped to 16 bits.
struct Columns {
  std::array<Vector3, 2> basis, gradient;
};
inline Columns columnsOf(const FitRow& row, const GaugeTriple& gauges) {
  Columns columns;
  for (std::size_t i = 0; i < gauges.size(); ++i) {
    const Unfolded gauge(gauges[i]);
    const auto weightIn = [&](const FoldedWeights& folded) {
      return clipped<16>(tabled(folded[gauge.even]) + gauge.sign * tabled(folded[gauge.odd]));
    };
    for (std::size_t j = 0; j < 2; ++j) {
      columns.basis[j][i] = ofColumn(row.basis[j], i, weightIn(row.basis[j]));
      columns.gradient[j][i] = ofColumn(row.gradient[j], i, weightIn(row.gradient[j]));
    }
  }
  return columns;
}

inline Number inner(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Cross product, / 2^15.
inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {(a[1] * b[2] - a[2] * b[1]) >> 15, (a[2] * b[0] - a[0] * b[2]) >> 15,
          (a[0] * b[1] - a[1] * b[0]) >> 15};
}

/// (a * low + b * high) / 2^13
inline Vector3 combined(const Vector3& a, const Vector3& b, Pair by) {
  Vector3 sum;
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = (a[i] * low(by) + b[i] * high(by)) >> 13;
  return sum;
}

}  // namespace strainfinger::firmware
