#pragma once
// The normal equations of a Gauss-Newton step, solved by an LDL^T decomposition in integers.

#include <array>
#include <cstdint>

#include "firmware/core/hypothesis.hpp"
#include "firmware/core/reciprocal.hpp"

namespace strainfinger::firmware {

inline constexpr int kMostUnknowns = 4 * kMostContacts;
/// Readings that one fit can use; even.
inline constexpr int kMostRows = 24;

using Vector = std::array<Number, kMostUnknowns>;
using Rows = std::array<Short, kMostRows>;

/// Columns are scaled so that each entry is below 2^13: sums of 24 products of two fit 31 bits.
inline constexpr int kColumnBits = 13;
inline constexpr int kLowerBits = 20;
inline constexpr int kStepBits = 14;

/// N = L D L^T. An unknown of which the others leave less than 2^-12 of its column's square is taken for
/// undetermined: its pivot is 0 and it keeps its value.
struct Decomposition {
  std::array<Vector, kMostUnknowns> lower_q20;  ///< L below its diagonal of ones
  Vector pivot;
  std::array<Reciprocal, kMostUnknowns> reciprocal;  ///< of the pivots; 0 of an undetermined unknown's
  std::uint8_t unknowns;

  bool isDetermined(int unknown) const { return reciprocal[static_cast<std::size_t>(unknown)].mantissa != 0; }
};

/// `columns`: of the unknowns, `rows` (even) entries each. Cost: unknowns^2 / 2 scalar products.
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
           const Rows& residual, const Vector& low_q14, const Vector& high_q14);

/// Diagonal of the inverse of N: variances of the unknowns in units of the columns, for readings of variance
/// 1 [* 2^50, saturating]; 0 where undetermined.
std::array<Wide, kMostUnknowns> variances(const Decomposition& decomposition);

}  // namespace strainfinger::firmware
