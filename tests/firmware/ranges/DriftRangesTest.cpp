// No intermediate result of zeros that follow drift leaves its word (firmware/core/drift_products.hpp), for
// any readings that conditioning gives, any contact and any tables that checkTableImage() accepts.
#include <algorithm>
#include <cstdint>
#include <limits>

#include "firmware/core/drift_products.hpp"
#include "tests/firmware/ranges/ranges_group.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP_BASE(DriftRanges, RangesGroup) {
  static constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  static constexpr int kSteps = 2 * kOuterReach + 1;
  static inline const Number kStrain =
      Number(-(1 << (15 + kMostGateShift)) + 1, (1 << (15 + kMostGateShift)) - 1);

  /// The sum of so many readings.
  static Number sumOf(int readings) {
    Number sum = 0;
    for (int i = 0; i < readings; ++i) sum += summand(kStrain);
    return sum;
  }
  /// What an average has changed since the touch came to rest.
  static Number anyChange() {
    return (sumOf(kAveraged) >> kAverageShift) - (sumOf(kAveraged) >> kAverageShift);
  }
  /// A sine of any fraction of a revolution, or all from `least` to `most`.
  static Number sines(int least, int most) {
    Number all = 0;
    for (int half = least; half <= most; ++half) {
      const Number sine = sine_q14(half);
      all = {std::min(all.least(), sine.least()), std::max(all.most(), sine.most())};
    }
    return all;
  }
  static Three three(Number each) { return {each, each, each}; }
  /// A contact's weight at a gauge of its window: Tangent::at, or what the outer pair's difference has of
  /// each.
  static Number anyWeight() {
    overRootTwo(anyOf(16));
    return anyOf(16) * Number(-1, 1);
  }
  static Three along(Number change) {
    AlongWays ways;
    for (int step = 0; step < kSteps; ++step)
      for (std::size_t way = 0; way < 3; ++way) ways.add(way, anyWeight(), change);
    return ways.components();
  }
  /// Splits changes of a ring by what a contact may have done.
  static void split(Number change, Number pattern) {
    const Three changeAlong = along(change), patternAlong = along(pattern);
    PatternSums sums;
    for (int gauge = 0; gauge < kMaxGauges; ++gauge) sums.add(three(pattern), change);
    sums.takeOut({patternAlong, patternAlong, patternAlong}, changeAlong);
    const Number gauges(kMinGauges, kMaxGauges);
    Symmetric inverse;
    adjoin(sums.matrix_q24(gauges), inverse);
    divideBy({std::int64_t{mostUndetermined(kMatrixBits)} + 1, kMost}, inverse);
    const Three shared = product_q12(inverse, sums.changes(gauges));
    const Number contact =
        withoutDrift(changeAlong[0], {patternAlong, patternAlong, patternAlong}, 0, shared);
    squareOf(contact) + squareOf(contact) + squareOf(contact);
    follow(withoutContact(change, three(anyWeight()), three(contact)));
  }
  static void follow(Number by) {
    absolute(by);
    followedZero({0, kMost}, by, {0, kMost});
  }
};

TEST(DriftRanges, SumsOfAnIntervalOverflowNothing) {
  anyChange();
  checkNone();
  sumOf(kAveraged + 1);
  CHECK(overflows > 0);
}

TEST(DriftRanges, NoSineOverflows) {
  turnTo({0, kMaxGauges}, {0.0L, 0x1p32L - 1});
  const Number all = sines(-(1 << 14), (1 << 14) - 1);
  CHECK(all.most() <= 1 << 14 && all.least() >= -(1 << 14));
  checkNone();
  sines(1 << 16, (1 << 16) + 1);
  CHECK(overflows > 0);
}

TEST(DriftRanges, SplittingAnyChangesOverflowsNothing) {
  const Number pattern(-(1 << 14), 1 << 14);
  split(anyChange(), pattern);
  checkNone();
  split(anyChange(), anyOf(18));
  CHECK(overflows > 0);
}

TEST(DriftRanges, FollowingByAnyStrainOverflowsNothing) {
  follow({-kMost, kMost});
  checkNone();
  follow(anyOf(32));
  CHECK(overflows > 0);
}

TEST(DriftRanges, TheSquareOfARingOverflowsNothing) {
  const Number average = sumOf(kAveraged) >> kAverageShift;
  const auto squareOfGauges = [&](int gauges) {
    Wide sum = 0;
    for (int gauge = 0; gauge < gauges; ++gauge) sum += squareOf(average);
    return sum;
  };
  squareOfGauges(kMaxGauges);  // as in gateEnergy()
  checkNone();
  squareOfGauges(kMaxGauges + 1);
  CHECK(overflows > 0);
}
