// No intermediate result of fits without some gauges leaves its word (firmware/core/tangent_products.hpp),
// for any readings, any of them left out, and any tables that checkTableImage() accepts.
#include <cmath>
#include <cstdint>
#include <limits>

#include "firmware/core/tangent_products.hpp"
#include "tests/firmware/ranges/ranges_group.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP_BASE(TangentRanges, RangesGroup) {
  static constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  /// Of a column that is no longer folded; the outer pair's weight is rounded, and so is the root of two.
  static inline const double kUnfoldedLength = kWeightLength + 1;

  static Short anyReading(std::size_t index, double length) {
    return Number::component(anyOf(16), length, 1u << index);
  }
  static int stepOf(std::size_t index) { return static_cast<int>(index) - kWindowReach; }
  static Number anyWeight(std::size_t index) {
    return Number::component(weightAt(provedRow.basis[0], stepOf(index)), kUnfoldedLength, 1u << index);
  }
  /// Loads of readings as long as they may be together, any of them left out.
  static LoadPair loadsOf(double length) {
    LoadPair pair;
    for (std::size_t i = 0; i < kReadings; ++i) {
      pair.add(anyWeight(i), anyWeight(i), anyReading(i, length));
      pair.leaveOut(anyWeight(i), anyWeight(i));
    }
    return pair;
  }
  static Number determined(int bits) { return {std::int64_t{mostUndetermined(bits)} + 1, kMost}; }

  static Number anyMove(std::size_t index) {
    return moveAt(provedRow, {anyOf(32), anyOf(32)}, stepOf(index));
  }
  /// Of a move of any length.
  static Natural anyEnergy() {
    Natural energy = 0;
    for (std::size_t i = 0; i < kReadings; ++i) energy += squared(anyMove(i));
    return {0.0L, static_cast<long double>(energy.most())};
  }
  /// Sums over readings along a move of any length and the loads of a row, with what leaving them out leaves.
  static Three sumsAlong(const Natural& energy, double length, Symmetric& left) {
    MoveLength move(energy);
    if (move.root == 0) return {};
    for (int exponent = kLeastGradientExponent; exponent <= kMostGradientExponent; ++exponent)
      move.steepness(exponent);
    Three sums;
    for (std::size_t i = 0; i < kReadings; ++i) {
      const Number component = Number::component(anyMove(i), kLongest * std::sqrt(kReadings), 1u << i);
      const Short load = clipped<16>(anyWeight(i));
      const Directions e{load, load, move.direction(component)};
      addAlong(sums, e, anyReading(i, length));
      takeOut(left, e);
      leverage_q15(e);
    }
    return sums;
  }
  static Symmetric all(Number element) { return {element, element, element, element, element, element}; }
  static SquareSums squaresOf(double length) {
    SquareSums sums;
    for (std::size_t i = 0; i < kReadings; ++i) sums.add(anyReading(i, length), anyOf(32));
    return sums;
  }
};

TEST(TangentRanges, AnyPositionHasAGaugeAndARowThatOverflowNothing) {
  const auto about = [](int gauge) {
    const std::int64_t middle = std::int64_t{gauge} * kOnePitch;
    const Number position(middle - kOnePitch / 2, middle + kOnePitch / 2 - 1);
    return nearestRowTo(offsetFrom(nearestGauge(position), position));
  };
  for (int gauge = 0; gauge <= kMaxGauges; ++gauge) CHECK(about(gauge).most() < kFitRows);
  const Number beyond(-kOnePitch / 8, kOnePitch / 8);
  for (const int side : {-1, 1}) placeOf({0, kMaxGauges - 1}, side, {0, kFitRows - 1}, beyond);
  checkNone();
  about(1 << 11);
  CHECK(overflows > 0);
}

TEST(TangentRanges, ScalingAnyStrainOverflowsNothing) {
  for (int up = 0; up <= 30; ++up) scaledStrain(anyOf(32), up);
  outerReading(Number(-0xFFFF, 0xFFFF) * Number(-1, 1));
  checkNone();
  scaledStrain(anyOf(32), 33);
  CHECK(overflows > 0);
}

TEST(TangentRanges, LoadsOfAnyReadingsLeftOverflowNothing) {
  const LoadPair pair = loadsOf(kReadingsLength);
  solved(pair);
  explainedBy(pair, determined(15));
  checkNone();
  loadsOf(4 * kReadingsLength);
  CHECK(overflows > 0);
}

TEST(TangentRanges, AMoveOfAnyLengthOverflowsNothing) {
  const Natural energy = anyEnergy();
  const auto along = [&](double length) {
    return forEachWay([&] {
      Symmetric left = all(1 << kMatrixBits);
      sumsAlong(energy, length, left);
    });
  };
  CHECK(along(kReadingsLength) > 60);
  checkNone();
  along(2 * kReadingsLength);
  CHECK(overflows > 0);
}

TEST(TangentRanges, InversesAndTheirProductsOverflowNothing) {
  Symmetric inverse;
  adjoin(all(anyOf(32)), inverse);
  divideBy(determined(kMatrixBits), inverse);
  CHECK(inverse[0].size() <= 1 << kCovarianceBits);  // see ErrorsWithGaugesLeftOutOverflowNothing
  product_q12(inverse, {anyOf(32), anyOf(32), anyOf(32)});
  checkNone();
  product_q12(all(anyOf(32)), {anyOf(32), anyOf(32), anyOf(32)});
  CHECK(overflows > 0);
}

TEST(TangentRanges, PredictionsOfAnyCoefficientsOverflowNothing) {
  const Short any = anyOf(16);
  const Number prediction = predictedFrom({any, any, any}, {anyOf(32), anyOf(32), anyOf(32)});
  any - wholeReading(prediction) * Number(-1, 1);
  for (int up = 0; up <= 30; ++up) predictedStrain(Wide{prediction} * Number(-1, 1), up);
  const Wide pair = timesRootTwo<Wide>(anyOf(32));
  besideOther(anyOf(32), pair * Number(-1, 1));
  lengthBeyond(anyOf(32), {1.0L, 0x1p62L});
  checkNone();
  lengthBeyond(anyOf(32), {0.0L, 0x1p62L});
  CHECK(overflows > 0);
}

TEST(TangentRanges, EnergiesOfReadingsLeftOverflowNothing) {
  const SquareSums sums = squaresOf(kReadingsLength);
  CHECK(sums.explained().most() < 1 << 28);
  checkNone();
  squaresOf(2 * kReadingsLength);
  CHECK(overflows > 0);
}
