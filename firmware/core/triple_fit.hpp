#pragma once
// The three-reading fit: offset and two loads from three gauges of a window, exactly.

#include <array>
#include <cstdint>

#include "firmware/core/window_fit.hpp"

namespace strainfinger::firmware {

using Vector3 = std::array<std::int32_t, 3>;

inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline std::int32_t inner(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector3 lowered(const Vector3& vector, int down) {
  return {vector[0] >> down, vector[1] >> down, vector[2] >> down};
}

/// What three gauges read, per unit of each unknown, for a contact near a row's offset: readings =
/// basis1 * projection 1 + basis2 * projection 2 + gradient * offset from the row.
struct TripleModel {
  Vector3 basis1, basis2;  ///< [* 2^15]
  Vector3 gradient;        ///< at given projections [scaled strain a pitch, / 2^gradient_exponent], 15 bits
};

/// `weighted`: the projections times the row's gradient lengths, as fitStep() makes them.
TripleModel tripleModel(const FitRow& row, const Triple& triple, Pair weighted);

/// The triple that a row has for the sense of a tangential load; the second projection has its sign.
inline int tripleFor(const FitRow& row, std::int32_t projection2) {
  return row.triple[projection2 < 0 ? kAgainstOffset : kWithOffset];
}

/// One Newton step of the three readings from the fit's row: its projections and length are then theirs.
/// Returns false where they say nothing.
bool solveTriple(const FitTable& rows, WindowFit& fit);

}  // namespace strainfinger::firmware
