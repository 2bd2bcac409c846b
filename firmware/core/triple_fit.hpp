#pragma once
// The three-reading fit: offset and two loads from three gauges of a window, exactly.

#include <array>
#include <cstdint>

#include "firmware/core/window_fit.hpp"

namespace strainfinger::firmware {

using Vector3 = std::array<std::int32_t, 3>;

inline std::int32_t inner(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Near a row's offset three gauges read basis1 * u1 + basis2 * u2 + gradient * (offset - row's): solved by
/// Cramer's rule with the cross products of the three vectors, all taken from the row of all seven gauges.
struct TripleSystem {
  Vector3 forOffset;       ///< basis1 x basis2 [* 2^15]
  Vector3 forProjection1;  ///< basis2 x gradient [as gradient]
  Vector3 forProjection2;  ///< gradient x basis1
  std::int32_t volume;     ///< basis1 x basis2 . gradient [* 2^15]; gradient: scaled strains a pitch
                           ///< / 2^gradient_exponent, below 2^14.5
};

/// The system of a row's best triple at given projections, whose second has the sign of the tangential load.
struct TripleChoice {
  GaugeTriple gauges;
  Vector3 basis1, basis2;
  TripleSystem system;
};
TripleChoice tripleChoice(const FitRow& row, const Projections& projection);

/// Newton steps of the three readings from a fit whose step was taken, until the next one would no longer
/// matter: its projections and length are then theirs. False: they lead away from it, or nowhere.
bool solveTriple(const FitTable& rows, int mirrorSign, WindowFit& fit);

}  // namespace strainfinger::firmware
