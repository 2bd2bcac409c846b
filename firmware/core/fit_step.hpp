#pragma once
// One step of a fit within a window, from a row of the table: all of the fit's arithmetic, no decisions.

#include <array>
#include <cstdint>

#include "common/table_image.hpp"
#include "firmware/core/quotients.hpp"
#include "firmware/core/signal.hpp"
#include "firmware/core/step_rule.hpp"

namespace strainfinger::firmware {

/// Offset from a window's middle gauge, in pitches * 2^20.
using PitchQ20 = std::int32_t;
inline constexpr int kPitchBits = 20;
inline constexpr PitchQ20 kOnePitch = 1 << kPitchBits;
inline constexpr int kRowBits = 14;
inline constexpr PitchQ20 kRowSpacing = 1 << kRowBits;
static_assert(kOnePitch / kRowSpacing == kRowsPerPitch);

/// The last step of a fit may be this long.
inline constexpr PitchQ20 kConverged = kRowSpacing * kConverged_eighths / 8;

/// Fits end within 2^this row spacings of their row.
inline constexpr int kBeyondRowBits = kConverged > 4 * kRowSpacing   ? 3
                                      : kConverged > 2 * kRowSpacing ? 2
                                      : kConverged > kRowSpacing     ? 1
                                                                     : 0;

using Projections = std::array<Number, 2>;

/// From a row of the table towards the offset where the window's readings fit best.
struct FitStep {
  Projections projection;  ///< onto the row's basis [scaled strain * 2^15]
  Number slope;            ///< of the energy, in units of the row's gradient
  Number information;      ///< energy of the gradient / 4^(gradient_exponent + 1)
  Number quotient;         ///< slope / information [* 2^14], at most 16 bits
  Number length;           ///< at most an eighth of a pitch either way, and 2^-gradient_exponent

  /// Energy explained once a step of full length is taken.
  Number energy() const {
    return addScaledByLow(energyOf(projection[0], projection[1]), slope * 4, lowOnly(quotient));
  }
};

/// Squared length of a row's gradient at weighted projections, below 2^26.
inline Number informationOf(Pair weighted, Pair cosine) {
  return addScaledByLow(dot(weighted, weighted), productOf(weighted) * 4, cosine);
}

/// slope / information [* 2^14], of 16 bits; 0 where the information says nothing.
inline Number quotientQ14(Number slope, Number information) {
  return clippedQuotient<16>(clipped<28>(slope) * 16, information >> 10);
}

inline Projections projectionsOn(const FitRow& row, const Signal& signal) {
  return {project(row.basis[0], signal), project(row.basis[1], signal)};
}

/// Projections times the lengths of the row's gradients [* 2^(-2 - gradient_exponent)]: norm below 2^12.5.
inline Pair weightedBy(const FitRow& row, const Projections& projection) {
  const Pair lengths = pairAt(row.gradient_length.data());
  return upperHalves(scaledByLow(projection[0], lengths), scaledByHigh(projection[1], lengths));
}

[[gnu::always_inline]] inline FitStep fitStep(const FitRow& row, const Signal& signal) {
  FitStep step;
  step.projection = projectionsOn(row, signal);
  const Number gradient1 = project(row.gradient[0], signal);
  const Number gradient2 = project(row.gradient[1], signal);
  const Pair weighted = weightedBy(row, step.projection);
  step.slope = addScaledByHigh(scaledByLow(gradient1, weighted), gradient2, weighted);
  step.information = informationOf(weighted, lowOnly(tabled(row.gradient_cosine)));
  step.quotient = quotientQ14(step.slope, step.information);
  // A quotient is a length in pitches * 2^20, 5 - gradient_exponent bits further left.
  static_assert(kLeastGradientExponent >= -3);
  step.length = clipped<kPitchBits - 2>((step.quotient * 256) >> (row.gradient_exponent + 3));
  return step;
}

/// Amplitudes of the two loads at the fit's offset, and how they change per row spacing of it. In strains at
/// the response's peak, scaled as the signal, * 2^(amplitude_exponent - 1). `tangential` is + towards the
/// fit's side.
struct Amplitudes {
  Number normal;
  Number tangential;
};
struct AmplitudeSlopes {
  Number normal;
  Number tangential;
};

/// A row's coefficient times a projection, * 2^-16.
inline Number times(std::int16_t coefficient, Number projection) {
  return scaledByLow(projection, lowOnly(tabled(coefficient)));
}
/// A row's pair of coefficients times both projections, * 2^-16.
inline Number times(Pair coefficients, const Projections& projection) {
  return addScaledByHigh(scaledByLow(projection[0], coefficients), projection[1], coefficients);
}

inline AmplitudeSlopes amplitudeSlopes(const FitRow& row, const Projections& projection) {
  return {times(pairAt(&row.load_slope[0]), projection), times(pairAt(&row.load_slope[2]), projection)};
}

inline Amplitudes amplitudesOf(const FitRow& row, const FitStep& step) {
  const AmplitudeSlopes slopes = amplitudeSlopes(row, step.projection);
  const Pair beyondRow = lowOnly(clipped<kRowBits + 1>(step.length >> kBeyondRowBits));
  const auto moved = [&](Number atRow, Number slope) {
    return atRow + scaledByLow(slope, beyondRow) * (1 << (16 - kRowBits + kBeyondRowBits));
  };
  return {moved(times(pairAt(&row.load[0]), step.projection), slopes.normal),
          moved(times(row.load[2], step.projection[1]), slopes.tangential)};
}

}  // namespace strainfinger::firmware
