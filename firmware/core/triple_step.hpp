#pragma once
// One step of a three-reading fit from a row of the table: all of its arithmetic, no decisions.

#include <array>

#include "firmware/core/fit_step.hpp"
#include "firmware/core/vector3.hpp"

namespace strainfinger::firmware {

/// Near a row's offset three gauges read basis1 * u1 + basis2 * u2 + gradient * (offset - row's): solved by
/// Cramer's rule with the cross products of the three vectors, all taken from the row of all seven gauges.
struct TripleSystem {
  Vector3 basis1, basis2;  ///< of the three gauges
  Vector3 forOffset;       ///< basis1 x basis2 [* 2^15]
  Vector3 forProjection1;  ///< basis2 x gradient [as gradient]
  Vector3 forProjection2;  ///< gradient x basis1
  Number volume;           ///< basis1 x basis2 . gradient [* 2^15]; gradient: scaled strains a pitch
                           ///< / 2^gradient_exponent
};

/// `projection`: up to what a step leaves.
inline TripleSystem tripleSystem(const FitRow& row, const GaugeTriple& gauges,
                                 const Projections& projection) {
  const Columns columns = columnsOf(row, gauges);
  const Vector3 gradient = combined(columns.gradient[0], columns.gradient[1], weightedBy(row, projection));
  TripleSystem system;
  system.basis1 = columns.basis[0];
  system.basis2 = columns.basis[1];
  system.forOffset = cross(system.basis1, system.basis2);
  system.forProjection1 = cross(system.basis2, gradient);
  system.forProjection2 = cross(gradient, system.basis1);
  system.volume = inner(system.forOffset, gradient);
  return system;
}

/// Twice what three gauges read.
inline Vector3 twiceRead(const Signal& signal, const GaugeTriple& gauges) {
  const auto& [even, odd] = signal;
  const std::array<Number, 8> numbers{low(even[0]) * 2, high(even[0]), low(even[1]), high(even[1]),
                                      low(odd[0]),      high(odd[0]),  low(odd[1]),  0};
  Vector3 twice;
  for (std::size_t i = 0; i < twice.size(); ++i) {
    const Unfolded gauge(gauges[i]);
    twice[i] = numbers[gauge.even] + numbers[gauge.odd] * gauge.sign;
  }
  return twice;
}

/// A row's weight [* 2^15] times a projection, doubled: as twiceRead().
inline Number twice(Number weight, Number projection) {
  return scaledByLow(projection, lowOnly(weight)) >> 13;
}

/// numerator / volume * 2^29, for a correction: of 13 digits, saturating at 2^28.
inline Number correction(Number numerator, Number volume) {
  return signedQuotient<15>(numerator, volume >> 15) * (1 << 14);
}

/// A system of less volume tells nothing, and is not divided by.
inline constexpr std::int32_t kLeastVolume = 1 << 16;

/// Corrects the projections of a row, and says where from it the three readings lead. What the row leaves of
/// a reading is clipped at 2^13: more is no contact there. |volume| at least kLeastVolume.
inline FitStep tripleStep(const FitRow& row, const TripleSystem& system, const Vector3& twiceRead,
                          const Projections& u) {
  Vector3 left;
  for (std::size_t i = 0; i < left.size(); ++i)
    left[i] = clipped<15>(twiceRead[i] - twice(system.basis1[i], u[0]) - twice(system.basis2[i], u[1]));
  FitStep step{};
  step.quotient = signedQuotient<16>(inner(system.forOffset, left), system.volume >> 13);
  step.projection = {u[0] + correction(inner(system.forProjection1, left), system.volume),
                     u[1] + correction(inner(system.forProjection2, left), system.volume)};
  step.length = clipped<kPitchBits - 2>((step.quotient * 512) >> (row.gradient_exponent + 3));
  return step;
}

}  // namespace strainfinger::firmware
