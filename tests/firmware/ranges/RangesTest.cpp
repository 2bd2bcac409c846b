// No intermediate result of the locator's arithmetic leaves its word, for any strains that conditioning gives
// and any tables that checkTableImage() accepts: the firmware's own code, compiled with bounds for numbers.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "firmware/core/condition.hpp"
#include "firmware/core/error_products.hpp"
#include "firmware/core/fit_step.hpp"
#include "firmware/core/near_triple.hpp"
#include "firmware/core/side_energies.hpp"
#include "firmware/core/triple_step.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP(Ranges){void setup() override{overflows = 0;
}
void checkNone() { LONGS_EQUAL(0, overflows); }

/// Any readings of a window, as long as they may be together.
static Signal anySignal() {
  const Number any(-32767, 32767, 16);  // below kFoldedLength
  const auto pair = [&](unsigned part) { return Pair{any, any, kSignalLength, part}; };
  return {{pair(1), pair(2)}, {pair(4), pair(8)}};
}
/// A step of any three readings, and what is made of its answer: amplitudes, and the system that its errors
/// come from.
static void threeSteps(const Signal& signal) {
  for (const GaugeTriple& gauges : kTripleList) {
    const Projections u = projectionsOn(provedRow, signal);
    const FitStep step =
        tripleStep(provedRow, tripleSystem(provedRow, gauges, u), twiceRead(signal, gauges), u);
    CHECK(step.length.most() < 1 << 17);
    amplitudesOf(provedRow, step);
    tripleSystem(provedRow, gauges, step.projection);
  }
}
/// The three nearest readings, solved between any two rows, for any information that all seven may have.
static void solveNearest(const NearSignal& signal) {
  const NearColumns columns = nearColumns(provedRow);
  const NearNormal normal = nearNormal(provedRow, columns);
  const Number closer = distanceFrom(normal, signal) - distanceFrom(normal, signal);
  const Number beyond = secantLength(distanceFrom(normal, signal), closer);
  closerSquared(provedRow, closer);
  leastCloser(normal, fitStep(provedRow, anySignal()).information);
  const NearQuotients quotients = nearQuotients(columns, normal.sum, signal);
  nearAmplitudes(provedRow, provedRow, nearProjections(between(quotients, quotients, beyond)), beyond);
}
/// Any readings of them, as long as they may be together.
static NearSignal anyNearSignal(double length) {
  const Number any(-32767, 32767, 16);
  return {{any, any, length, 1}, {any, any, length, 4}};
}
/// Of any deviations and covariances of so many bits.
static void variance(int deviationBits, int covarianceBits) {
  const auto any = [](int bits) { return Number(-(std::int64_t{1} << bits), std::int64_t{1} << bits); };
  const Number d = any(deviationBits), c = any(covarianceBits);
  quadraticForm({d, d, d}, {c, c, c, c, c, c});
}
/// Folds any window of a length [signal]. Of two readings the sum is longest where they are equal.
static void fold(double length, int up) {
  const double alone = std::min(std::ldexp(length, 16 - up), std::exp2(15 + kMostGateShift));
  const auto any = [](double most) {
    const auto limit = static_cast<std::int64_t>(most);
    return Number(-limit, limit);
  };
  const Number half = any(alone / std::sqrt(2.0));
  const std::array<Number, kWindowGauges> window{half, half, half, any(alone), half, half, half};
  foldedSignal(window.data(), up);
  nearSignal(half, any(alone), half, up);
}
/// Calls visit for a row of each scale that tables may have.
template <typename Visit>
static void forEachScale(Visit visit) {
  for (int exponent = kLeastGradientExponent; exponent <= kMostGradientExponent; ++exponent) {
    provedRow.gradient_exponent = static_cast<std::int8_t>(exponent);
    visit();
  }
}
}
;

TEST(Ranges, AStepOverflowsNothing) {
  forEachScale([&] {
    const FitStep step = fitStep(provedRow, anySignal());
    step.energy();
    CHECK(step.length.most() < 1 << 17);
  });
  checkNone();
}

TEST(Ranges, AmplitudesAndTheirSlopesOverflowNothing) {
  forEachScale([&] { amplitudesOf(provedRow, fitStep(provedRow, anySignal())); });
  checkNone();
}

TEST(Ranges, AStepOfThreeReadingsAndItsAmplitudesOverflowNothing) {
  forEachScale([&] { threeSteps(anySignal()); });
  checkNone();
}

TEST(Ranges, TheThreeNearestReadingsBetweenTwoRowsOverflowNothing) {
  forEachScale([&] { solveNearest(anyNearSignal(kSignalLength)); });
  checkNone();
  solveNearest(anyNearSignal(4 * kSignalLength));
  CHECK(overflows > 0);
}

TEST(Ranges, WhatThreeReadingsWeighInAnErrorOverflowsNothing) {
  forEachScale([] {
    const Signal signal = anySignal();
    const Number any(-32768, 32767);
    for (const GaugeTriple& gauges : kTripleList) {
      const Projections u = projectionsOn(provedRow, signal);
      const FitStep step =
          tripleStep(provedRow, tripleSystem(provedRow, gauges, u), twiceRead(signal, gauges), u);
      const Number slope = amplitudeSlopes(provedRow, step.projection).normal;
      amplitudeWeight(provedRow, tripleSystem(provedRow, gauges, step.projection), 0, {any, any}, slope);
    }
  });
  checkNone();
}

TEST(Ranges, TheVarianceWithGaugesLeftOutOverflowsNothing) {
  variance(kDeviationBits, kCovarianceBits);
  checkNone();
  variance(kDeviationBits + 2, kCovarianceBits);
  CHECK(overflows > 0);
}

TEST(Ranges, ALongerSignalWouldBeFoundInThreeReadings) {
  Signal signal = anySignal();
  for (Pair* pair : {&signal.even[0], &signal.even[1], &signal.odd[0], &signal.odd[1]})
    pair->length = 1.3 * kSignalLength;
  fitStep(provedRow, signal);
  checkNone();  // all seven have room for that
  threeSteps(signal);
  CHECK(overflows > 0);
}

TEST(Ranges, EnergiesOverflowNothing) {
  const Signal signal = anySignal();
  energyOf(signal);
  exactEnergies(sideParts(provedRow, signal));
  roughEnergies(sideParts(provedRow, signal));
  checkNone();
}

TEST(Ranges, AnyCodeZeroAndGainGivesAStrainOfTheGate) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  conditioned(Number(0, 0xFFFF), Number(0, kMost), Number(0, kMost));
  checkNone();
  for (int gateShift = 0; gateShift <= kMostGateShift; ++gateShift) {  // see usableGain()
    const std::int64_t gain = std::min(kMost, (std::int64_t{1} << (16 + gateShift)) - 2);
    const Number strain = conditioned(Number(0, 0xFFFF), Number(0, kMost), Number(0, gain));
    CHECK(strain.most() < std::int64_t{1} << (15 + gateShift));
    CHECK(strain.least() > -(std::int64_t{1} << (15 + gateShift)));
  }
  // .. the sum of whose squares fits 63 bits, with the most gauges and the coarsest gate.
  constexpr std::uint64_t kLargest = (std::uint64_t{1} << (15 + kMostGateShift)) - 1;
  static_assert(kLargest * kLargest * kMaxGauges < std::uint64_t{1} << 63);
  checkNone();
  conditioned(Number(0, 0x10000), Number(0, kMost), Number(0, kMost));
  CHECK(overflows > 0);
}

TEST(Ranges, FoldingOverflowsNothing) {
  for (int up = 0; up <= 30; ++up) fold(kSignalLength - 1, up);  // 1: rounding, see ProblemTest
  checkNone();
  fold(kSignalLength + 1, 10);
  CHECK(overflows > 0);
}

TEST(Ranges, ASignalTwiceAsLongWouldBeFound) {
  Signal signal = anySignal();
  for (Pair* pair : {&signal.even[0], &signal.even[1], &signal.odd[0], &signal.odd[1]})
    pair->length = 4 * kSignalLength;
  fitStep(provedRow, signal);
  CHECK(overflows > 0);
}

TEST(Ranges, APairTakenThreeTimesWouldBeFound) {
  const Signal signal = anySignal();
  const Pair weights = pairAt(&provedRow.basis[0][0]);
  const Number twice = dot(weights, signal.even[0], dot(weights, signal.even[0]));
  checkNone();
  dot(weights, signal.even[0], twice);
  CHECK(overflows > 0);
}
