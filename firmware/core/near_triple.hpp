#pragma once
// The three readings around a window's middle gauge, which folding leaves together: where between two rows of
// the table a contact explains them exactly, and with which loads. All of the arithmetic, no decisions.
//
// Their responses to the two loads span a plane, which turns with the contact's offset: it holds the readings
// where its normal is at right angles to them.

#include "firmware/core/fit_step.hpp"

namespace strainfinger::firmware {

/// Middle reading, sum and difference of the two beside it, as in a Signal: the first words of its parts.
struct NearSignal {
  Pair even, odd;
};

/// Of strains within +-2^29, divided and rounded as foldedSignal() does.
inline NearSignal nearSignal(Number minus, Number middle, Number plus, int up) {
  const Number half = 0x8000 >> up;
  return {upperHalves(raised(middle + half, up), raised(plus + half + minus, up)),
          upperHalves(raised(plus + half - minus, up), 0)};
}
/// .. as seen from a side of the window.
inline NearSignal seenFrom(const NearSignal& signal, int side, int mirrorSign) {
  constexpr Pair kZero{};
  if (side > 0) return signal;
  if (mirrorSign > 0) return {signal.even, kZero - signal.odd};
  return {kZero - signal.even, signal.odd};
}

/// A row's weights for middle reading and difference, of both columns of its basis.
struct NearColumns {
  Pair first, second;
};
inline NearColumns nearColumns(const FitRow& row) {
  return {lows(pairAt(&row.basis[0][0]), pairAt(&row.basis[0][4])),
          lows(pairAt(&row.basis[1][0]), pairAt(&row.basis[1][4]))};
}

/// Normal of the plane of a row's responses [* 2^29, the middle one * 2^28]: folding halved the weights of
/// sum and difference.
struct NearNormal {
  Number middle, sum, difference;
};
inline NearNormal nearNormal(const FitRow& row, const NearColumns& columns) {
  const Pair even1 = pairAt(&row.basis[0][0]), even2 = pairAt(&row.basis[1][0]);
  return {
      determinant(lowAndHigh(pairAt(&row.basis[0][4]), even1), lowAndHigh(pairAt(&row.basis[1][4]), even2)),
      determinant(columns.first, columns.second), determinant(even2, even1)};
}

/// How far the readings are from a row's plane [signal * 2^10].
inline Number distanceFrom(const NearNormal& normal, const NearSignal& signal) {
  return mulHigh(normal.middle, low(signal.even) * (1 << 12)) +
         mulHigh(normal.sum, high(signal.even) * (1 << 11)) +
         mulHigh(normal.difference, low(signal.odd) * (1 << 11));
}

/// Where between two neighbouring rows the distance vanishes, or up to two rows beyond [their spacing *
/// 2^14].
inline Number secantLength(Number here, Number closer) {
  return signedQuotient<kRowBits + 2>(clipped<23>(here) * 256, nonZero(closer >> 6));
}

/// What `closer` has to be for an offset whose error is sqrt(2) times that of all seven gauges, which have so
/// much information (see FitStep); both squared.
inline Number leastCloser(const NearNormal& normal, Number information) {
  const Number middle = normal.middle >> 16;
  const Pair beside = upperHalves(normal.sum, normal.difference);
  return mulHigh(middle * middle + (dot(beside, beside) >> 1), information) >> 3;
}
inline Number closerSquared(const FitRow& row, Number closer) {
  const Number lowered = clipped<16>(closer >> (row.gradient_exponent + 9 + kRowStrideBits));
  return lowered * lowered;
}

/// The projections that the middle reading and the difference call for, and one divisor of both.
struct NearQuotients {
  Number first, second;  ///< [signal * 2^15]
  Number divisor;        ///< [* 2^30]
};
inline NearQuotients nearQuotients(const NearColumns& columns, Number divisor, const NearSignal& signal) {
  const Pair middleDifference = lows(signal.even, lowOnly(low(signal.odd) >> 1));
  return {determinant(middleDifference, columns.second), determinant(columns.first, middleDifference),
          divisor};
}

/// Between two rows [/ 4].
inline Number between(Number here, Number next, Number beyond) {
  const Number quarter = here >> 2;
  return quarter + clipped<28>(scaledByLow((next >> 2) - quarter, lowOnly(beyond))) * 4;
}
inline NearQuotients between(const NearQuotients& here, const NearQuotients& next, Number beyond) {
  return {between(here.first, next.first, beyond), between(here.second, next.second, beyond),
          between(here.divisor, next.divisor, beyond)};
}

/// The least divisor [/ 4] that tells the loads well enough.
inline constexpr std::int32_t kLeastDivisor = 3 << 24;

/// |divisor| at least the least one.
inline Projections nearProjections(const NearQuotients& quotients) {
  const Number inverse = signedQuotient<18>(1 << 30, nonZero(quotients.divisor >> 12)) * (1 << 13);
  const auto projection = [&](Number numerator) { return clipped<24>(mulHigh(numerator, inverse)) * 128; };
  return {projection(quotients.first), projection(quotients.second)};
}

/// Amplitudes of the loads between two rows.
inline Amplitudes nearAmplitudes(const FitRow& here, const FitRow& next, const Projections& projection,
                                 Number beyond) {
  const auto moved = [&](Number atRow, Number atNext) {
    return atRow + clipped<28>(scaledByLow((atNext >> 1) - (atRow >> 1), lowOnly(beyond))) * 8;
  };
  return {moved(times(pairAt(&here.load[0]), projection), times(pairAt(&next.load[0]), projection)),
          moved(times(here.load[2], projection[1]), times(next.load[2], projection[1]))};
}

}  // namespace strainfinger::firmware
