#pragma once
// The fit within one window: Gauss-Newton steps of a variable projection from tabled rows.

#include <algorithm>
#include <array>
#include <cstdint>

#include "common/table_image.hpp"
#include "firmware/core/signal.hpp"

namespace strainfinger::firmware {

/// Offset from a window's middle gauge, in pitches * 2^20.
using PitchQ20 = std::int32_t;
inline constexpr int kPitchBits = 20;
inline constexpr PitchQ20 kOnePitch = 1 << kPitchBits;
inline constexpr int kRowBits = 14;
inline constexpr PitchQ20 kRowSpacing = 1 << kRowBits;
static_assert(kOnePitch / kRowSpacing == kRowsPerPitch);

/// A step this short lands so near its row that another would change nothing that matters; a little more than
/// half a spacing, so that two neighbouring rows can't hand a fit to and fro.
inline constexpr PitchQ20 kConverged = kRowSpacing * 5 / 8;

using Projections = std::array<std::int32_t, 2>;

/// From a row of the table towards the offset where the window's readings fit best.
struct FitStep {
  Projections projection;    ///< onto the row's basis [scaled strain * 2^15]
  std::int32_t slope;        ///< of the energy, in units of the row's gradient
  std::int32_t information;  ///< energy of the gradient / 4^(gradient_exponent + 1)
  std::int32_t quotient;     ///< slope / information [* 2^14], at most 16 bits
  PitchQ20 length;           ///< at most an eighth of a pitch either way

  /// Energy explained once a step of full length is taken.
  std::int32_t energy() const {
    return addScaledByLow(energyOf(projection[0], projection[1]), slope * 4, lowOnly(quotient));
  }
};

/// Squared length of a row's gradient at weighted projections, below 2^26.
inline std::int32_t informationOf(Pair weighted, Pair cosine) {
  return addScaledByLow(dot(weighted, weighted), productOf(weighted) * 4, cosine);
}

/// slope / information [* 2^14], of 16 bits; 0 where the information says nothing.
/// |slope| < 2^26.5, information < 2^26.
inline std::int32_t quotientQ14(std::int32_t slope, std::int32_t information) {
  const std::int32_t divisor = information >> 10;
  return divisor <= 0 ? 0 : clipped<16>(slope * 16 / divisor);
}

inline Projections projectionsOn(const FitRow& row, const Signal& signal) {
  return {project(row.basis[0], signal), project(row.basis[1], signal)};
}

/// Projections times the lengths of the row's gradients [* 2^(-2 - gradient_exponent)]: norm below 2^12.5.
inline Pair weightedBy(const FitRow& row, const Projections& projection) {
  const Pair lengths = pairAt(row.gradient_length.data());
  return upperHalves(scaledByLow(projection[0], lengths), scaledByHigh(projection[1], lengths));
}

inline FitStep fitStep(const FitRow& row, const Signal& signal) {
  FitStep step;
  step.projection = projectionsOn(row, signal);
  const std::int32_t gradient1 = project(row.gradient[0], signal);
  const std::int32_t gradient2 = project(row.gradient[1], signal);
  const Pair weighted = weightedBy(row, step.projection);
  step.slope = addScaledByHigh(scaledByLow(gradient1, weighted), gradient2, weighted);
  step.information = informationOf(weighted, lowOnly(row.gradient_cosine));
  step.quotient = quotientQ14(step.slope, step.information);
  // A quotient is a length in pitches * 2^20, 5 - gradient_exponent bits further left.
  static_assert(kLeastGradientExponent >= -3);
  step.length = clipped<kPitchBits - 2>((step.quotient * 256) >> (row.gradient_exponent + 3));
  return step;
}

/// A contact as one window sees it.
struct WindowFit {
  Signal signal;  ///< as seen from `side`
  int centre;     ///< the window's middle gauge
  int side;       ///< +1: the offset counts towards +theta
  int row;        ///< that the step was taken from
  FitStep step;

  /// At a row (negative: on the - side), before the first step.
  void start(const Signal& window, int middle, int atRow, int mirrorSign) {
    signal = atRow >= 0 ? window : mirrored(window, mirrorSign);
    centre = middle;
    side = atRow >= 0 ? 1 : -1;
    row = absolute(atRow);
  }

  /// From the middle gauge; may come out slightly negative.
  PitchQ20 offset() const { return row * kRowSpacing + step.length; }
  PitchQ20 position() const { return centre * kOnePitch + side * offset(); }
  bool converged() const { return step.length <= kConverged && step.length >= -kConverged; }
};

inline int nearestRow(PitchQ20 offset) {
  return std::min<int>((offset + kRowSpacing / 2) >> kRowBits, kFitRows - 1);
}

/// To the row nearest to where the last step leads; over the middle gauge if need be.
inline void follow(WindowFit& fit, int mirrorSign) {
  PitchQ20 offset = fit.offset();
  if (offset < 0) {
    offset = -offset;
    fit.side = -fit.side;
    fit.signal = mirrored(fit.signal, mirrorSign);
  }
  fit.row = nearestRow(offset);
}

inline void takeStep(const FitTable& rows, WindowFit& fit) {
  fit.step = fitStep(rows[static_cast<std::size_t>(fit.row)], fit.signal);
}

/// Steps from the fit's row until the next one would no longer matter, within 5/8 of a row spacing of its
/// row: two are typical. False: not there after eight steps, or walked beyond the last row; the fit is then
/// no answer.
inline bool refine(const FitTable& rows, int mirrorSign, WindowFit& fit) {
  constexpr int kMaxSteps = 8;
  for (int left = kMaxSteps;; --left) {
    takeStep(rows, fit);
    if (fit.converged() || left == 1) return fit.converged();
    follow(fit, mirrorSign);
  }
}

/// Amplitudes of the two loads at the fit's offset, and how they change per row spacing of it. In strains at
/// the response's peak, scaled as the signal, * 2^(amplitude_exponent - 1). `tangential` is + towards the
/// fit's side.
struct Amplitudes {
  std::int32_t normal;
  std::int32_t tangential;
};
struct AmplitudeSlopes {
  std::int32_t normal;
  std::int32_t tangential;
};

/// A row's coefficient times a projection, * 2^-16.
inline std::int32_t times(std::int16_t coefficient, std::int32_t projection) {
  return scaledByLow(projection, lowOnly(coefficient));
}

inline AmplitudeSlopes amplitudeSlopes(const FitRow& row, const Projections& projection) {
  return {times(row.load_slope[0], projection[0]) + times(row.load_slope[1], projection[1]),
          times(row.load_slope[2], projection[0]) + times(row.load_slope[3], projection[1])};
}

inline Amplitudes amplitudesOf(const FitRow& row, const FitStep& step) {
  const auto [u1, u2] = step.projection;
  const AmplitudeSlopes slopes = amplitudeSlopes(row, step.projection);
  const Pair beyondRow = lowOnly(clipped<kRowBits + 1>(step.length));
  const auto moved = [&](std::int32_t atRow, std::int32_t slope) {
    return atRow + scaledByLow(slope, beyondRow) * (1 << (16 - kRowBits));
  };
  return {moved(times(row.load[0], u1) + times(row.load[1], u2), slopes.normal),
          moved(times(row.load[2], u2), slopes.tangential)};
}

}  // namespace strainfinger::firmware
