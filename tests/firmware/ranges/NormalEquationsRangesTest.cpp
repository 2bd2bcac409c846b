// The normal equations' own code with bounds for numbers: any columns and residuals of their formats.
#include "firmware/core/normal_equations.cpp"  // NOLINT: its arithmetic is what is proved

#include "tests/firmware/ranges/ranges_group.hpp"

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP_BASE(NormalEquationsRanges, RangesGroup) {
  static constexpr int kEntry = 1 << kColumnBits;
  static constexpr std::int64_t kMostLower = std::int64_t{1} << kLowerLimitBits;
  using Columns = std::array<Rows, kMostUnknowns>;

  static Columns anyColumns(int entry = kEntry) {
    Columns columns;
    for (Rows& column : columns) column.fill(within<Short>(entry));
    return columns;
  }
  /// As decompose() leaves it, see ADecompositionOverflowsNothing; the mantissa is 0 of undetermined ones.
  static Decomposition anyDecomposition(int unknowns, int leastMantissa = 0) {
    Decomposition any;
    any.unknowns = static_cast<std::uint8_t>(unknowns);
    any.lower_q20.fill(within(kMostLower));
    any.pivot.fill({0, Number::kMost});
    any.reciprocal.fill({{leastMantissa, 1 << 30}, {-60, 0}});
    return any;
  }
  static void solveAny(const Decomposition& decomposition) {
    constexpr std::int64_t kLimit = 1 << 28;
    Vector high, low;
    high.fill({0, kLimit});
    low.fill({-kLimit, 0});
    for (const int shift : {0, kMostResidualShift}) {
      Residual residual;
      residual.value.fill(within<Short>(kEntry));
      residual.shift = shift;
      const Step step = solve(decomposition, anyColumns(), kMaxGauges, residual, low, high);
      for (const Number& x : step.x_q14) checkWithin(x, -kLimit, kLimit);
      checkWithin(step.reduction, -kMostReduction, kMostReduction);
    }
  }
};

TEST(NormalEquationsRanges, ADecompositionOverflowsNothing) {
  const Columns columns = anyColumns();
  const int ways = forEachWay([&] {
    Decomposition decomposition;
    decompose(columns, kMaxGauges, kMostUnknowns, decomposition);
    for (std::size_t i = 0; i < kMostUnknowns; ++i) {
      checkWithin(decomposition.pivot[i], 0, Number::kMost);
      checkWithin(decomposition.reciprocal[i].mantissa, 0, 1 << 30);
      checkWithin(decomposition.reciprocal[i].exponent, -60, 0);
    }
    for (const Number& lower : decomposition.lower_q20) checkWithin(lower, -kMostLower, kMostLower);
  });
  LONGS_EQUAL(1 << kMostUnknowns, ways);
  checkNone();
}

TEST(NormalEquationsRanges, EntriesOfTwoBitsMoreWouldOverflowADecomposition) {
  const Columns columns = anyColumns(4 * kEntry);
  forEachWay([&] {
    Decomposition decomposition;
    decompose(columns, kMaxGauges, 1, decomposition);
  });
  checkSome();
}

TEST(NormalEquationsRanges, AStepOfDeterminedUnknownsOverflowsNothing) {
  const int ways = forEachWay([] { solveAny(anyDecomposition(kMostUnknowns, 1 << 28)); });
  CHECK_TRUE(ways > 1 << kMostUnknowns);
  checkNone();
}

// In a step of eight the undetermined ones only add zeros, which the bounds of determined ones hold.
TEST(NormalEquationsRanges, AStepOfSomeUnknownsThatAreUndeterminedOverflowsNothing) {
  constexpr int kUnknowns = 3;
  const int ways = forEachWay([] { solveAny(anyDecomposition(kUnknowns)); });
  CHECK_TRUE(ways > 1 << kUnknowns);
  checkNone();
}

TEST(NormalEquationsRanges, VariancesOverflowNothing) {
  const int ways = forEachWay([] {
    for (const Wide& variance : variances(anyDecomposition(kMostUnknowns)))
      checkWithin(variance, 0, std::int64_t{1} << 61);
  });
  LONGS_EQUAL(1 << kMostUnknowns, ways);
  checkNone();
}
