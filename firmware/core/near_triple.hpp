#pragma once
// The three readings around a window's middle gauge: where between two near rows a contact explains them
// exactly, and with which loads. All of the arithmetic, no decisions.
//
// Their responses to the two loads span a plane, which turns with the contact's offset: it holds the readings
// where its normal is at right angles to them.

#include "firmware/core/fit_step.hpp"

namespace strainfinger::firmware {

inline constexpr int kNearBits = kRowBits + 1;
static_assert(kNearStride == 1 << (kNearBits - kRowBits));

/// How far the readings are from a row's plane, times the length of its normal [signal * 2^14].
inline Number distanceFrom(const NearRow& row, const Signal& signal) {
  return dot(pairAt(&row.normal[2]), signal.odd[0], dot(pairAt(&row.normal[0]), signal.even[0]));
}

/// A quantity at three neighbouring rows.
struct AtRows {
  Number first, second, third;

  Number bend() const { return third - second - (second - first); }
};

/// Lengths from the first of the rows [their spacing * 2^12].
inline constexpr int kBetweenBits = 12;

/// A quantity over how much one falls from the first row to the second [* 2^12], at most 8.
inline Number overFall(Number value, Number fall) {
  return signedQuotient<16>(clipped<27>(value) * 16, nonZero(fall >> 8));
}

/// length * (length - 1) / 2 [* 2^12], of a length between -1/4 and 5/4.
inline Number secondOrder(Number length) {
  return (length * (length - (1 << kBetweenBits))) >> (kBetweenBits + 1);
}

/// Where the distances vanish, from where a straight line does (-1/4 to 5/4 from the first), or up to a
/// quarter of a spacing from there.
inline Number curved(const AtRows& distances, Number straight) {
  const Number bend = overFall(distances.bend(), distances.first - distances.second);
  return straight + clipped<kBetweenBits - 1>((bend * secondOrder(straight)) >> kBetweenBits);
}

/// 1 / (1 - offset / pole) of an offset that is no nearer to the pole than a near row [* 2^14, at most 2^20].
inline Number poleFactor(Number offset_q15, Number pole_q15) {
  return signedQuotient<21>(pole_q15 * (1 << 14), nonZero(pole_q15 - offset_q15));
}

/// Amplitude of a load that middle reading and difference call for at a length between -1/2 and 3/2 from a
/// row. Saturates at 2^30.
using NearLoad = std::array<std::int16_t, 2> NearRow::*;
inline Number nearAmplitude(const NearRow* row, NearLoad load, Pair readings, Number length, Number factor) {
  const Number here = dot(pairAt((row[0].*load).data()), readings);
  const Number next = dot(pairAt((row[1].*load).data()), readings);
  const Number between = here + scaledByLow(next - here, lowOnly(length)) * (1 << (16 - kBetweenBits));
  return clipped<23>(mulHigh(between, factor * (1 << 10))) * (1 << 8);
}

/// Energy that all seven readings say is explained at an offset from a row, as if it were the best one: the
/// row's, and what a step of that length gains.
inline Number energyBeside(const FitRow& row, const Projections& projection, Number information,
                           Number beyond) {
  const Number quotient = clipped<16>((beyond * (1 << (row.gradient_exponent + 3))) >> 8);
  const Number gained = scaledByLow(scaledByLow(information, lowOnly(quotient)) * 16, lowOnly(quotient));
  return energyOf(projection[0], projection[1]) + gained;
}

}  // namespace strainfinger::firmware
