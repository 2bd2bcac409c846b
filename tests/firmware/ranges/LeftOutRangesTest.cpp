// No intermediate result of the search without some gauges, and of that for a gauge that fails, leaves its
// word (left_out_products.hpp, gauge_watch_products.hpp, energies.hpp of firmware/core), for any readings and
// any tables that checkTableImage() accepts.
#include <cstdint>
#include <limits>

#include "firmware/core/gauge_watch_products.hpp"
#include "firmware/core/left_out_products.hpp"
#include "tests/firmware/ranges/ranges_group.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP_BASE(LeftOutRanges, RangesGroup) {
  static Number upTo(std::int64_t most) { return {0, most}; }
  /// A ring's, as problemOf() says; a tail, noise and any energy that is no more than 32 bits.
  static inline const Number kRing = upTo(1 << 28);
  static inline const Number kTail = upTo(0xFFFF);
  static inline const Number kNoise = Number(1, kMostNoise);
  static inline const Number kSaturating = upTo(std::numeric_limits<std::int32_t>::max());
  static Number anyReading(std::size_t index, double length) {
    return Number::component(anyOf(16), length, 1u << index);
  }

  /// Of a window's readings, the outer pair's included, as long as they may be together.
  static Number windowOf(double length) {
    Number window = 0;
    for (std::size_t i = 0; i < kReadings; ++i) window += energyOf(anyReading(i, length));
    return window;
  }
  /// Outside a window that lacks any of its gauges.
  static Number outsideOf(double length) {
    WindowEnergies window{energyOf(anyReading(kWindowGauges, length))};
    for (std::size_t i = 0; i < kWindowGauges; ++i) {
      window.add(anyReading(i, length));
      window.addMissing(anyOf(32));
    }
    return window.outside(kRing, kTail);
  }
  /// Any gauge of the ring is inside, or outside.
  static Split splitOf(double length) {
    Split split;
    for (std::size_t i = 0; i < kMaxGauges; ++i) {
      split.addInside(energyOf(anyReading(i, length)));
      split.addOutside(energyOf(anyReading(i, length)));
    }
    return split;
  }
};

TEST(LeftOutRanges, WhatIsOutsideAWindowOverflowsNothing) {
  SquareSums sums;
  for (std::size_t i = 0; i < kReadings; ++i) sums.add(Short(anyReading(i, kReadingsLength)), anyOf(32));
  sums.explained() + outsideOf(kReadingsLength);
  checkNone();
  outsideOf(2 * kReadingsLength);
  CHECK(overflows > 0);
}

TEST(LeftOutRanges, AmplitudesOfAnyCoefficientsOverflowNothing) {
  const Three any{anyOf(32), anyOf(32), anyOf(32)};
  for (const int side : {-1, 1}) insideCone(amplitudesAt(provedRow, side, any), upTo(0xFFFF));
  for (int up = -30; up <= 30; ++up) rescaled(anyOf(32), up);
  checkNone();
  rescaled(anyOf(32), 33);
  CHECK(overflows > 0);
}

TEST(LeftOutRanges, MarginsOfAnyNoiseOverflowNothing) {
  for (const int count : {1, 12, 64}) leastOfRivals(anyOf(32), energyOfVariances(kNoise, count));
  noiseAndPart(energyOfVariances(kNoise, 64), kRing, 0);
  checkNone();
  noiseAndPart(kSaturating, kRing, 0);
  CHECK(overflows > 0);
}

TEST(LeftOutRanges, EnergiesAboutAnyWindowOverflowNothing) {
  for (const int shift : {0, 3}) splitOf(kRingLength).leastUnexplained(shift);
  leftOf(kRing, anyOf(32));
  checkNone();
  splitOf(2 * kRingLength);
  CHECK(overflows > 0);
}

TEST(LeftOutRanges, LeavingAnyGaugeOutOverflowsNothing) {
  const Number window = windowOf(kReadingsLength), leverage(-(1 << 18), 1 << 18);
  const LeftOut without = leftOut(anyOf(16), anyOf(32), leverage);
  for (const bool isInside : {true, false}) {
    Unexplained unexplained{kSaturating, kRing, window};
    isInside ? unexplained.leaveInside(anyOf(16), without) : unexplained.leaveOutside(energyOf(anyOf(16)));
    if (!isInside) unexplained.leaveOuter(energyOf(anyOf(16)), without);
    unexplained.energy(kTail);
  }
  checkNone();
  leftOut(anyOf(16), anyOf(32), anyOf(32));
  CHECK(overflows > 0);
}

TEST(LeftOutRanges, TellingCulpritsApartOverflowsNothing) {
  const Number noise = energyOfVariances(kNoise, 64);
  mostLikeIt((kRing >> 4) + noise, noise);
  kRing + excessOutside(kRing - kRing, kRing, kTail);  // unexplained inside and outside: a misfit
  checkNone();
  mostLikeIt(kSaturating, noise);
  CHECK(overflows > 0);
}

TEST(LeftOutRanges, OneGaugeAgainstTheOthersOverflowsNothing) {
  const auto judge = [](int gateShift, int strainBits) {
    const std::int64_t most = (std::int64_t{1} << strainBits) - 1;
    const Number strain(-most, most);
    jumpOf(strain, strain);
    const Number own = gatePart(strain, gateShift);
    Wide{0.0L, 0x1p32L - 1} - own;  // of the ring's energy
    muchOf(own);
    leastAtRail(strain);
    offBy(strain, strain);
  };
  farOff(anyOf(16), anyOf(16));
  for (int gateShift = 0; gateShift <= kMostGateShift; ++gateShift) judge(gateShift, 15 + gateShift);
  checkNone();
  judge(0, 17);
  CHECK(overflows > 0);
}
