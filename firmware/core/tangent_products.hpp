#pragma once
// The arithmetic of what a contact can do to the readings of a window (tangent.hpp): all that
// could leave its word, no decisions.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "firmware/core/energies.hpp"
#include "firmware/core/error_products.hpp"
#include "firmware/core/fit_step.hpp"
#include "firmware/core/integer_root.hpp"

namespace strainfinger::firmware {

/// What is read at steps -kWindowReach .. fitReach(): a gauge each, but at kOuterReach, as one reading, the
/// difference of the outer pair (+ side minus - side) over sqrt(2), which has the noise of a gauge.
inline constexpr std::size_t kReadings = kWindowGauges + 1;
constexpr std::size_t indexOf(int step) { return static_cast<std::size_t>(step + kWindowReach); }
/// Of 17 bits.
inline Number overRootTwo(Number number) { return (number * 23170 + (1 << 14)) >> 15; }
/// Of 16 bits, or more where they are Wide.
template <typename Integer>
Integer timesRootTwo(Integer number) {
  return (number * 46341 + (1 << 14)) >> 15;
}

/// Three numbers a reading, or three combinations of the window's readings.
using Three = std::array<Number, 3>;
/// Symmetric 3 x 3: 11, 12, 13, 22, 23, 33.
using Symmetric = std::array<Number, 6>;
/// Where a reading is along three directions of unit length in the space of all readings [* 2^15].
using Directions = std::array<Short, 3>;

/// Components of moves and residuals saturate here: the squares of eight fit 63 bits. They are so long only
/// where the readings left hardly determine them.
inline constexpr std::int32_t kLongest = (1 << 30) - 1;

/// Fewer than this part of the information left is none, as a power of two.
inline constexpr int kDeterminedShift = 12;
/// Determinants of so many bits after the point are more than this, or nothing is determined.
constexpr std::int32_t mostUndetermined(int bits) { return 1 << (bits - kDeterminedShift); }

/// The gauge nearest to a position of a ring [pitches * 2^20], how far it is from there, and the row nearest
/// to that.
inline Number nearestGauge(Number position) { return (position + kOnePitch / 2) >> kPitchBits; }
inline Number offsetFrom(Number gauge, Number position) { return position - gauge * kOnePitch; }
inline Number nearestRowTo(Number offset) { return (absolute(offset) + kRowSpacing / 2) >> kRowBits; }
/// The position beyond a row of a window's side; may be up to a pitch outside the ring.
inline Number placeOf(Number centre, int side, Number row, Number beyondRow) {
  return centre * kOnePitch + side * (row * kRowSpacing + beyondRow);
}

/// A strain divided by 2^(16 - up), rounded, saturating; `up` is 0 .. 30.
[[gnu::noinline]] inline Short scaledStrain(Number strain_q32, int up) {
  return shortened((Wide{strain_q32} * (Wide{1} << up) + (1 << 15)) >> 16);
}

/// The outer pair's reading from its difference, of 17 bits.
inline Short outerReading(Number difference) {
  return static_cast<Short>(clipped<16>(overRootTwo(difference)));
}

/// A column's weight of the reading at a step, which folding halved or, of the outer pair, divided by
/// sqrt(2).
inline Number weightAt(const FoldedWeights& folded, int step) {
  if (step == 0) return tabled(folded[0]);
  if (step > kWindowReach) return timesRootTwo<Number>(tabled(folded[kWindowGauges]));
  const auto distance = static_cast<std::size_t>(std::abs(step));
  return tabled(folded[distance]) + (step > 0 ? 1 : -1) * tabled(folded[distance + kWindowReach]);
}

/// Two loads' sums over the readings left [signal * 2^15], and what is left of a 2 x 2 identity without the
/// others [* 2^15].
struct LoadPair {
  Number first = 0, second = 0;
  Number left11 = 1 << 15, left12 = 0, left22 = 1 << 15;

  void add(Number weight1, Number weight2, Number reading) {
    first += weight1 * reading;
    second += weight2 * reading;
  }
  void leaveOut(Number weight1, Number weight2) {
    left11 -= weight1 * weight1 >> 15;
    left12 -= weight1 * weight2 >> 15;
    left22 -= weight2 * weight2 >> 15;
  }
  Number determinant_q15() const { return Number((Wide{left11} * left22 - Wide{left12} * left12) >> 15); }
};

/// The loads' coefficients of the readings left [signal * 2^6], saturating.
inline std::array<Number, 2> solved(const LoadPair& pair) {
  const Wide determinant = atLeast(pair.determinant_q15(), 1);
  const auto coefficient = [&](Wide numerator) { return saturated((numerator >> 9) / determinant); };
  return {coefficient(Wide{pair.left22} * pair.first - Wide{pair.left12} * pair.second),
          coefficient(Wide{pair.left11} * pair.second - Wide{pair.left12} * pair.first)};
}

/// Energy that they explain of the readings left, saturating; `determinant_q15` is more than
/// mostUndetermined().
inline Number explainedBy(const LoadPair& pair, Number determinant_q15) {
  const Number u1 = pair.first >> 15, u2 = pair.second >> 15;
  const Wide energy =
      (Wide{u1} * u1 * pair.left22 - Wide{u1} * u2 * pair.left12 * 2 + Wide{u2} * u2 * pair.left11) >> 17;
  return saturated(energy * (1 << 15) / determinant_q15);
}

/// What a move changes at a step: W u, saturating.
inline Number moveAt(const FitRow& row, const std::array<Number, 2>& loads, int step) {
  Wide component = 0;
  for (std::size_t i = 0; i < 2; ++i)
    component += weightAt(row.gradient[i], step) * ((Wide{loads[i]} * tabled(row.gradient_length[i])) >> 15);
  return Number(limited(component >> 15, kLongest));
}

/// Length of a move, of which the squares of all components are given: root * 2^halved, the root 0 or in
/// [2^14, 2^15).
struct MoveLength {
  Natural energy;
  int halved;
  Number root;

  explicit MoveLength(Natural energyOfAll) : energy(energyOfAll), halved((35 - leadingZeros(energy)) >> 1) {
    root = Number(integerRoot(lowWord(halved >= 0 ? energy >> (2 * halved) : energy << (-2 * halved))));
  }

  /// One of the components, once the length is 1 [* 2^15]. The root is not 0.
  Short direction(Number component) const {
    const Number known = noLonger(component, energy);
    const Number scaled = halved >= 0 ? known >> halved : known * (1 << -halved);
    return static_cast<Short>(clipped<16>(scaled * (1 << 15) / root));
  }
  /// [signal * 2^6]
  Wide steepness(int gradientExponent) const {
    const int up = halved + gradientExponent;
    return up >= 0 ? Wide{root} << up : Wide{root} >> -up;
  }
};

inline constexpr int kMatrixBits = 24;

/// Adds a reading along its directions.
inline void addAlong(Three& sums, const Directions& e, Short reading) {
  for (std::size_t k = 0; k < 3; ++k) sums[k] += e[k] * reading;
}
/// Takes a reading out of an identity [* 2^24].
inline void takeOut(Symmetric& left, const Directions& e) {
  std::size_t element = 0;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t j = k; j < 3; ++j) left[element++] -= e[k] * e[j] >> (30 - kMatrixBits);
}

/// The adjoint of any matrix, in its format, and the determinant; all saturating.
[[gnu::noinline]] inline Number adjoin(const Symmetric& m, Symmetric& adjoint_q24) {
  const Number a = m[0], b = m[1], c = m[2], d = m[3], e = m[4], f = m[5];
  const auto times = [](Number one, Number other) { return (Wide{one} * other) >> kMatrixBits; };
  adjoint_q24 = {narrowed(times(d, f) - times(e, e)), narrowed(times(c, e) - times(b, f)),
                 narrowed(times(b, e) - times(c, d)), narrowed(times(a, f) - times(c, c)),
                 narrowed(times(b, c) - times(a, e)), narrowed(times(a, d) - times(b, b))};
  return narrowed(times(a, adjoint_q24[0]) + times(b, adjoint_q24[1]) + times(c, adjoint_q24[2]));
}

/// From the adjoint [* 2^24] to the inverse [* 2^12], which saturates; the determinant is more than
/// mostUndetermined().
inline void divideBy(Number determinant, Symmetric& adjoint_q24) {
  for (Number& element : adjoint_q24)
    element = Number(limited(Wide{element} * (1 << 12) / determinant, 1 << kCovarianceBits));
}

/// matrix * vector, saturating. The matrix [* 2^12] is one that divideBy() gives.
inline Three product_q12(const Symmetric& m, const Three& v) {
  const auto row = [&](std::size_t a, std::size_t b, std::size_t c) {
    return narrowed((Wide{m[a]} * v[0] + Wide{m[b]} * v[1] + Wide{m[c]} * v[2]) >> 12);
  };
  return {row(0, 1, 2), row(1, 3, 4), row(2, 4, 5)};
}

/// What should be read [signal * 2^4], saturating.
inline Number predictedFrom(const Directions& e, const Three& coefficients) {
  Wide reading = 0;
  for (std::size_t k = 0; k < 3; ++k) reading += Wide{e[k]} * coefficients[k];
  return saturated((reading + (1 << 14)) >> 15);
}
/// Without the four bits that a prediction has below a signal.
inline Number wholeReading(Number prediction) { return Number((Wide{prediction} + 8) >> 4); }

/// value * 2^up, rounded down, saturating; `value` of 32 bits or one more, `up` -30 .. 30.
[[gnu::noinline]] inline Number rescaled(Wide value, int up) {
  return saturated(up >= 0 ? value * (Wide{1} << up) : value >> -up);
}
/// A prediction, of 32 bits or one more, as a strain; saturating. `up` as in scaledStrain().
inline Number predictedStrain(Wide prediction, int up) { return rescaled(prediction, 12 - up); }
/// One of the outer pair as the other says that it should read, which reads so much more than it; saturating.
inline Number besideOther(Number other_q32, Wide more_q32) { return saturated(more_q32 + other_q32); }

/// Squares of a window's readings, and of what is left of them.
struct SquareSums {
  Number read = 0;       ///< [signal^2]
  Natural residual = 0;  ///< [signal^2 * 2^8]

  void add(Short reading, Number prediction) {
    read += squareOfShort(reading);
    residual += squared(limited(Wide{reading} * 16 - prediction, kLongest));
  }
  /// As an energy, saturating.
  Number unexplained() const { return saturated(Wide(residual >> 10)); }
  Number explained() const { return (read >> 2) - unexplained(); }
};

/// How much of its own reading a fit takes [* 2^15].
inline Number leverage_q15(const Directions& e) {
  Number sum = 0;
  for (const Number each : e) sum += each * each >> 15;
  return sum;
}

/// Where a contact is beyond the view's row [pitches * 2^20], from how much of the readings is along a move;
/// an eighth of a pitch at most. The steepness is not 0.
inline Number lengthBeyond(Number alongMove, Wide steepness) {
  return Number(limited(Wide{alongMove} * (1 << (kPitchBits + 2)) / steepness, kOnePitch / 8));
}

}  // namespace strainfinger::firmware
