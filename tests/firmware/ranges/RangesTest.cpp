// No intermediate result of the locator's arithmetic leaves its word, for any strains that conditioning gives
// and any tables that checkTableImage() accepts: the firmware's own code, compiled with bounds for numbers.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>

#include "firmware/core/condition.hpp"
#include "firmware/core/error_products.hpp"
#include "firmware/core/fit_step.hpp"
#include "firmware/core/near_triple.hpp"
#include "firmware/core/side_energies.hpp"
#include "firmware/core/told_start.hpp"
#include "firmware/core/triple_step.hpp"
#include "firmware/core/units.hpp"
#include "tests/firmware/ranges/ranges_group.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP_BASE(Ranges, RangesGroup) {
  /// Any readings of a window, as long as they may be together.
  static Signal anySignal() {
    const Number any(-32767, 32767, 16);  // below kFoldedLength
    const auto pair = [&](unsigned part) { return Pair{any, any, kSignalLength, part}; };
    return {{pair(1), pair(2)}, {pair(4), pair(8)}};
  }
  /// A step of any three readings, and what is made of its answer: amplitudes, and the system that its errors
  /// come from.
  static void threeSteps(const Signal& signal) {
    forEachTriple(signal, [](const GaugeTriple& gauges, const FitStep& step) {
      CHECK(step.length.most() < 1 << 17);
      amplitudesOf(provedRow, step);
      tripleSystem(provedRow, gauges, step.projection);
    });
  }
  /// Calls visit for any step of each triple, of a volume of either sign that is no less than that.
  template <typename Visit>
  static void forEachTriple(const Signal& signal, Visit visit, std::int64_t leastVolume = kLeastVolume) {
    for (const GaugeTriple& gauges : kTripleList) {
      const Projections u = projectionsOn(provedRow, signal);
      TripleSystem system = tripleSystem(provedRow, gauges, u);
      const Number any = system.volume;
      for (const Number& volume : {Number(any.least(), -leastVolume), Number(leastVolume, any.most())}) {
        system.volume = volume;
        visit(gauges, tripleStep(provedRow, system, twiceRead(signal, gauges), u));
      }
    }
  }
  /// What each of three readings weighs in the amplitudes of a row.
  static void weigh(const TripleSystem& system, const Projections& projection) {
    const Number any = anyOf(16), slope = amplitudeSlopes(provedRow, projection).normal;
    for (std::size_t reading = 0; reading < 3; ++reading)
      amplitudeWeight(provedRow, system, reading, {any, any}, slope);
  }
  /// The three nearest readings, solved between any near rows, and judged by all seven beside any row.
  static void solveNearest(const Signal& signal) {
    const AtRows away{distanceFrom(provedNear[0], signal), distanceFrom(provedNear[1], signal),
                      distanceFrom(provedNear[2], signal)};
    const Number fall = away.first - away.second, one = 1 << kBetweenBits;
    mulHigh(fall, fall);
    overFall(away.first, fall);
    const Number straight(-one.most() / 4, 5 * one.most() / 4);
    const Number length = curved(away, straight);
    CHECK(length.least() >= -one.most() / 2 && length.most() < 3 * one.most() / 2);
    const Pair readings = lows(signal.even[0], signal.odd[0]);
    constexpr int kPastLast_q15 = ((kNearRows - 3) * 2 + 3) << 9;  // 3/2 rows behind the last that is tried
    static_assert(kPastLast_q15 < kLeastNearPole_q15);
    const Number factor = poleFactor({-(1 << 9), kPastLast_q15}, {kLeastNearPole_q15, 0xFFFF});
    for (const NearLoad load : {&NearRow::normal_load, &NearRow::tangential_load})
      nearAmplitude(provedNear.data(), load, readings, length, factor);
    const Projections u = projectionsOn(provedRow, signal);
    const Number information =
        informationOf(weightedBy(provedRow, u), lowOnly(tabled(provedRow.gradient_cosine)));
    energyBeside(provedRow, u, information, {-3 * kRowSpacing / 4, kRowSpacing / 2});
  }
  /// Three weights of any column, and of one that is as long as it may be.
  static Vector3 anyColumn(std::size_t column) {
    const FoldedWeights& weights = provedRow.basis[column];
    return {ofColumn(weights, 0, anyOf(16)), ofColumn(weights, 1, anyOf(16)),
            ofColumn(weights, 2, anyOf(16))};
  }
  template <typename Random>
  static Vector3 someColumn(Random & random) {
    std::normal_distribution<double> along;
    const std::array<double, 3> way{along(random), along(random), along(random)};
    const double scale = 32767 / std::hypot(way[0], way[1], way[2]);
    Vector3 column;
    for (std::size_t i = 0; i < 3; ++i) column[i] = static_cast<std::int64_t>(way[i] * scale);
    return column;
  }
  static void checkHeld(const Number& bounds, const Number& number) {
    CHECK(bounds.least() <= number.least() && number.most() <= bounds.most());
  }
  static void checkHeld(const Vector3& bounds, const Vector3& vector) {
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      checkHeld(bounds[i], vector[i]);
      square += static_cast<double>(vector[i].least() * vector[i].least());
    }
    CHECK(std::sqrt(square) <= bounds[0].length());
  }
  /// .. as if they could be so many times as long.
  static Signal longer(double times) {
    Signal signal = anySignal();
    for (Pair* pair : {&signal.even[0], &signal.even[1], &signal.odd[0], &signal.odd[1]})
      pair->length = times * kSignalLength;
    return signal;
  }
  /// Of any deviations and covariances of so many bits.
  static void variance(int deviationBits, int covarianceBits) {
    const auto any = [](int bits) { return Number(-(std::int64_t{1} << bits), std::int64_t{1} << bits); };
    const Number d = any(deviationBits), c = any(covarianceBits);
    quadraticForm({d, d, d}, {c, c, c, c, c, c});
  }
  /// The noise of any tables that usable() admits, and scales at which its exponent is least, 0 and most;
  /// that roots stand any is shown by itself.
  static constexpr int kLeastExponent = kLeastNoiseExponent - 2 * 16 - 2;
  static constexpr int kMostExponent = kMostNoiseExponent + 2 * (30 - 16) - 2;
  template <typename Sigma>
  static int forEachNoise(Sigma sigma, std::uint64_t most = kMostNoiseVariance) {
    int ways = 0;
    for (const int exponent : {kLeastExponent, kMostExponent})
      ways += forEachWay([&] { sigma(Scaled{Natural(0.0L, static_cast<long double>(most)), exponent}); });
    return ways;
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
    foldedSignal(window.data(), up, foldedOuter(half, half, up));
  }
  /// Calls visit for a row of each scale that tables may have.
  template <typename Visit>
  static void forEachScale(Visit visit) {
    for (int exponent = kLeastGradientExponent; exponent <= kMostGradientExponent; ++exponent) {
      provedRow.gradient_exponent = static_cast<std::int8_t>(exponent);
      visit();
    }
  }
};

TEST(Ranges, AStepOverflowsNothing) {
  const auto steps = [](const Signal& signal) {
    forEachScale([&] {
      forEachWay([&] {
        const FitStep step = fitStep(provedRow, signal);
        step.energy();
        CHECK(step.length.most() < 1 << 17);
      });
    });
  };
  steps(anySignal());
  checkNone();
  steps(longer(4));
  CHECK(overflows > 0);
}

TEST(Ranges, AmplitudesAndTheirSlopesOverflowNothing) {
  forEachScale([&] { forEachWay([&] { amplitudesOf(provedRow, fitStep(provedRow, anySignal())); }); });
  checkNone();
  amplitudesOf(
      provedRow,
      {.projection = {anyOf(32), anyOf(32)}, .slope = 0, .information = 0, .quotient = 0, .length = 0});
  CHECK(overflows > 0);
}

TEST(Ranges, AStepOfThreeReadingsAndItsAmplitudesOverflowNothing) {
  forEachScale([&] { threeSteps(anySignal()); });
  checkNone();
  threeSteps(longer(1.3));
  CHECK(overflows > 0);
}

TEST(Ranges, ProductsOfVectorsHaveBoundsThatHoldThoseOfAllVectors) {
  constexpr unsigned kSeed = 62;
  std::printf("seed %u ", kSeed);
  std::mt19937 random(kSeed);
  const Vector3 a = anyColumn(0), b = anyColumn(1);
  const Number any(-5000, 5000), reading(-(1 << 14), 1 << 14);
  const Vector3 sum = combined(a, b, {any, any}), product = cross(a, sum);
  const Number volume = inner(product, b), explained = inner(product, {reading, reading, reading});
  checkNone();
  for (int trial = 0; trial < 10'000; ++trial) {
    const auto within = [&](std::int64_t most) {
      return Number(std::uniform_int_distribution<std::int64_t>(-most, most)(random));
    };
    const Vector3 a1 = someColumn(random), b1 = someColumn(random);
    const Vector3 sum1 = combined(a1, b1, {within(5000), within(5000)}), product1 = cross(a1, sum1);
    checkHeld(sum, sum1);
    checkHeld(product, product1);
    checkHeld(volume, inner(product1, b1));
    checkHeld(explained, inner(product1, {within(1 << 14), within(1 << 14), within(1 << 14)}));
  }
}

TEST(Ranges, AVolumeThatMayBeNoneWouldBeFound) {
  const auto ofVolume = [](std::int64_t least) {
    forEachTriple(
        anySignal(), [](const auto&, const auto&) {}, least);
  };
  ofVolume(kLeastVolume / 2);
  checkNone();
  ofVolume(kLeastVolume / 2 - 1);
  CHECK(overflows > 0);
}

TEST(Ranges, TheThreeNearestReadingsBetweenNearRowsOverflowNothing) {
  forEachScale([&] { forEachWay([&] { solveNearest(anySignal()); }); });
  checkNone();
  forEachWay([&] { solveNearest(longer(2)); });
  CHECK(overflows > 0);
}

TEST(Ranges, AToldStartOverflowsNothing) {
  const auto start = [](const Signal& signal) {
    forEachWay([&] { CHECK(toldOffset(provedStart, signal).size() <= 1 << kStartWeightBits); });
  };
  start(anySignal());
  checkNone();
  start(longer(4));
  CHECK(overflows > 0);
}

TEST(Ranges, WhatThreeReadingsWeighInAnErrorOverflowsNothing) {
  forEachScale([] {
    forEachTriple(anySignal(), [](const GaugeTriple& gauges, const FitStep& step) {
      weigh(tripleSystem(provedRow, gauges, step.projection), step.projection);
    });
  });
  checkNone();
  TripleSystem beyond{};
  beyond.forOffset = {anyOf(32), anyOf(32), anyOf(32)};
  weigh(beyond, {1 << 16, 1 << 16});
  checkNone();
  weigh(beyond, {anyOf(32), 1 << 16});
  CHECK(overflows > 0);
}

TEST(Ranges, TheVarianceWithGaugesLeftOutOverflowsNothing) {
  variance(kDeviationBits, kCovarianceBits);
  checkNone();
  variance(kDeviationBits + 2, kCovarianceBits);
  CHECK(overflows > 0);
}

TEST(Ranges, EnergiesOverflowNothing) {
  const auto energies = [](const Signal& signal) {
    energyOf(signal);
    exactEnergies(sideParts(provedRow, signal));
    roughEnergies(sideParts(provedRow, signal));
  };
  energies(anySignal());
  checkNone();
  energies(longer(2));
  CHECK(overflows > 0);
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
  static_assert(4 * kLargest < std::uint64_t{1} << 31);  // a bend of the strains
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

TEST(Ranges, APairTakenThreeTimesWouldBeFound) {
  const Signal signal = anySignal();
  const Pair weights = pairAt(&provedRow.basis[0][0]);
  const Number twice = dot(weights, signal.even[0], dot(weights, signal.even[0]));
  checkNone();
  dot(weights, signal.even[0], twice);
  CHECK(overflows > 0);
}

TEST(Ranges, RootsAndPlainNumbersOfAnySizeOverflowNothing) {
  const auto ofAll = [](std::uint64_t most) {
    for (int exponent = -300; exponent < 300; ++exponent)
      forEachWay([&] {
        const Number found = root({Natural(0.0L, static_cast<long double>(most)), exponent});
        CHECK(found.least() >= 0);
      });
  };
  ofAll((std::uint64_t{1} << 62) + ((std::uint64_t{1} << 62) - 1));
  for (int exponent = -300; exponent < 63; ++exponent)
    forEachWay([&] { plain({Natural(0.0L, 0x1p64L - 1), exponent}); });
  LONGS_EQUAL(65, forEachWay([] { normalised(Natural(0.0L, 0x1p64L - 1)); }));
  checkNone();
  ofAll(~std::uint64_t{0});
  CHECK(overflows > 0);
}

TEST(Ranges, ErrorsOfAllSevenReadingsOverflowNothing) {
  const auto ofNoise = [](std::uint64_t most) {
    int ways = 0;
    forEachScale([&] {
      if (provedRow.gradient_exponent % 5 != 2) return;  // -3, 2, 7, 12
      const Number information = informationOf(weightedBy(provedRow, projectionsOn(provedRow, anySignal())),
                                               lowOnly(tabled(provedRow.gradient_cosine)));
      ways += forEachNoise(
          [&](Scaled noise) { offsetSigma(noise, information, provedRow.gradient_exponent); }, most);
    });
    return ways;
  };
  CHECK(ofNoise(kMostNoiseVariance) > 1000);
  checkNone();
  ofNoise(std::uint64_t{1} << 57);
  CHECK(overflows > 0);
}

TEST(Ranges, ErrorsOfLoadsOverflowNothing) {
  const Number gain = anyOf(16), offset(0, std::numeric_limits<std::int32_t>::max());
  const Number slope = amplitudeSlopes(provedRow, projectionsOn(provedRow, anySignal())).normal;
  const auto sigma = [&](Scaled noise) { amplitudeSigma(noise, {gain, gain}, slope, offset); };
  CHECK(forEachNoise(sigma) > 100);
  forEachNoise([&](Scaled noise) { deviationsOf(noise, {gain, gain}, slope, offset); });
  checkNone();
  forEachNoise(sigma, std::uint64_t{1} << 33);
  CHECK(overflows > 0);
}

TEST(Ranges, ErrorsWithGaugesLeftOutOverflowNothing) {
  const Wide any(-0x1p63L + 1, 0x1p63L - 1);  // what deviationsOf() gives has as many bits
  const auto sigma = [&](int bits) {
    const Number c(-(std::int64_t{1} << bits), std::int64_t{1} << bits);
    return forEachWay([&] { reducedSigma({any, any, any}, {c, c, c, c, c, c}); });
  };
  CHECK(sigma(kCovarianceBits) > 1000);
  checkNone();
  sigma(kCovarianceBits + 2);
  CHECK(overflows > 0);
}

TEST(Ranges, ErrorsOfThreeReadingsOverflowNothing) {
  Vector3 weights;
  for (std::size_t i = 0; i < 3; ++i) weights[i] = anyOf(32);
  const auto sigma = [&](Scaled noise) { weightedSigma(noise, weights, 20, anyOf(32)); };
  CHECK(forEachNoise(sigma) > 1000);
  checkNone();
  forEachNoise(sigma, std::uint64_t{1} << 33);
  CHECK(overflows > 0);
}

TEST(Ranges, LoadsOverflowNothingWhateverTheirScale) {
  for (int gateShift = 0; gateShift <= kMostGateShift; ++gateShift)
    for (int load = std::numeric_limits<std::int16_t>::min(); usableLoads(load, gateShift); ++load)
      lineLoad(anyOf(32), anyOf(32), load + 16 - (14 - gateShift));  // the least `up`: see problemOf()
  checkNone();
  lineLoad(anyOf(32), anyOf(32), 0);
  CHECK(overflows > 0);
}

TEST(Ranges, AnglesOfAnyPlaceOverflowNothing) {
  const Number anywhere(0, kMaxGauges * kOnePitch);
  revolutions(Natural(0.0L, 0x1p32L - 1), anywhere);
  CHECK(centidegrees(Natural(0.0L, 0x1p32L - 1)).most() == 36000);
  CHECK(wholeDegrees(anyOf(32)).most() <= 180);
  checkNone();
  revolutions(Natural(0.0L, 0x1p40L), anywhere);
  const int found = overflows;
  CHECK(found > 0);
  centidegrees(Natural(0.0L, 0x1p49L));
  CHECK(overflows > found);
}

TEST(Ranges, ForcesOfAnyLoadOverflowNothing) {
  for (const int halvings : {0, 1}) force({0.0L, 0x1p32L - 1}, anyOf(32), halvings);
  checkNone();
  force({0.0L, 0x1p33L}, anyOf(32), 0);
  CHECK(overflows > 0);
}
