#pragma once
// The normal equations of a Gauss-Newton step, solved by an LDL^T decomposition in integers.

#include <array>
#include <cstdint>

#include "firmware/core/hypothesis.hpp"
#include "firmware/core/integers.hpp"

namespace strainfinger::firmware {

inline constexpr int kMostUnknowns = 4 * kMostContacts;

using Vector = std::array<Number, kMostUnknowns>;
/// One entry for each gauge, in the ring's order.
using Rows = std::array<Short, kMaxGauges>;

/// Entries of columns and residuals lie within +-2^12, so that a sum of 32 products of two stays within 2^29.
inline constexpr int kColumnBits = 12;
inline constexpr int kLowerBits = 20;
inline constexpr int kStepBits = 14;
inline constexpr int kStepLimitBits = 28;

/// The normal matrix as N = L D L^T. An unknown counts as undetermined if the unknowns before it leave less
/// than 2^-12 of its column's sum of squares: its pivot is set to 0 and no step changes it.
struct Decomposition {
  std::array<Number, kMostUnknowns*(kMostUnknowns - 1) / 2> lower_q20;  ///< L below its diagonal, row by row
  Vector pivot;
  std::array<Reciprocal, kMostUnknowns> reciprocal;  ///< of the pivots; 0 of an undetermined unknown's
  std::uint8_t unknowns;

  /// Row i of L, which has i entries.
  Number* lower(int i) { return lower_q20.data() + i * (i - 1) / 2; }
  const Number* lower(int i) const { return lower_q20.data() + i * (i - 1) / 2; }
  bool isDetermined(int unknown) const { return reciprocal[index(unknown)].mantissa != 0; }
};

/// Readings minus predictions, as value * 2^shift. Zeros fill the entries up to a multiple of 4.
struct Residual {
  alignas(4) Rows value;
  int shift;  ///< at most kMostResidualShift

  /// Sum of squares.
  Wide energy(int rows) const { return Wide{dot(value.data(), value.data(), rows)} << (2 * shift); }
};
inline constexpr int kMostResidualShift = 11;

/// `columns`: one for each unknown, with `rows` entries, a multiple of 4. Cost: unknowns^2 / 2 scalar
/// products.
void decompose(const std::array<Rows, kMostUnknowns>& columns, int rows, int unknowns,
               Decomposition& decomposition);

/// A step in units of the columns [* 2^kStepBits].
struct Step {
  Vector x_q14;
  Wide reduction;  ///< by which the residuals' sum of squares falls, if the linear model holds
};

/// The least-squares step that explains `residual`. Back-substitution clamps each unknown to low .. high and
/// then solves the unknowns before it for the clamped value.
Step solve(const Decomposition& decomposition, const std::array<Rows, kMostUnknowns>& columns, int rows,
           const Residual& residual, const Vector& low_q14, const Vector& high_q14);

/// Diagonal of the inverse of N: variances of the unknowns in units of the columns, for readings of variance
/// 1 [* 2^50, saturating]; 0 where undetermined.
std::array<Wide, kMostUnknowns> variances(const Decomposition& decomposition);

}  // namespace strainfinger::firmware
