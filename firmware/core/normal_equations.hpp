#pragma once
// The normal equations of a Gauss-Newton step, solved by an LDL^T decomposition in integers.

#include <array>
#include <cstdint>

#include "firmware/core/hypothesis.hpp"
#include "firmware/core/integers.hpp"

namespace strainfinger::firmware {

inline constexpr int kMostUnknowns = 4 * kMostContacts;

using Vector = std::array<Number, kMostUnknowns>;
/// One entry a gauge of the ring, in its order.
using Rows = std::array<Short, kMaxGauges>;

/// Entries of columns and residuals lie within +-2^12: sums of 32 products of two stay within 2^29.
inline constexpr int kColumnBits = 12;
inline constexpr int kLowerBits = 20;
inline constexpr int kStepBits = 14;
inline constexpr int kStepLimitBits = 28;

/// N = L D L^T. An unknown of which the others leave less than 2^-12 of its column's square is taken for
/// undetermined: its pivot is 0 and it keeps its value.
struct Decomposition {
  std::array<Number, kMostUnknowns*(kMostUnknowns - 1) / 2> lower_q20;  ///< L below its diagonal, row by row
  Vector pivot;
  std::array<Reciprocal, kMostUnknowns> reciprocal;  ///< of the pivots; 0 of an undetermined unknown's
  std::uint8_t unknowns;

  /// Where row i of L begins, of i entries.
  Number* lower(int i) { return lower_q20.data() + i * (i - 1) / 2; }
  const Number* lower(int i) const { return lower_q20.data() + i * (i - 1) / 2; }
  bool isDetermined(int unknown) const { return reciprocal[index(unknown)].mantissa != 0; }
};

/// What the readings differ by from what is predicted: value * 2^shift, a multiple of 4 of them, the last
/// ones 0.
struct Residual {
  alignas(4) Rows value;
  int shift;  ///< at most kMostResidualShift

  /// Sum of squares.
  Wide energy(int rows) const { return Wide{dot(value.data(), value.data(), rows)} << (2 * shift); }
};
inline constexpr int kMostResidualShift = 11;

/// `columns`: of the unknowns, `rows` entries each, a multiple of 4. Cost: unknowns^2 / 2 scalar products.
void decompose(const std::array<Rows, kMostUnknowns>& columns, int rows, int unknowns,
               Decomposition& decomposition);

/// A step in units of the columns [* 2^kStepBits].
struct Step {
  Vector x_q14;
  Wide reduction;  ///< of the residuals' sum of squares, by the linear model
};

/// The least-squares step to `residual`, each unknown's within low .. high, given those behind it: an unknown
/// at its limit stays there and those before it are solved anew.
Step solve(const Decomposition& decomposition, const std::array<Rows, kMostUnknowns>& columns, int rows,
           const Residual& residual, const Vector& low_q14, const Vector& high_q14);

/// Diagonal of the inverse of N: variances of the unknowns in units of the columns, for readings of variance
/// 1 [* 2^50, saturating]; 0 where undetermined.
std::array<Wide, kMostUnknowns> variances(const Decomposition& decomposition);

}  // namespace strainfinger::firmware
