#include "firmware/core/normal_equations.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include <CppUTest/TestHarness.h>

using namespace strainfinger::firmware;

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

constexpr Number kFree = 1 << 28;

}  // namespace

TEST_GROUP(NormalEquations) {
  static constexpr int kRows = 16;
  std::mt19937_64 random{102};
  alignas(4) std::array<Rows, kMostUnknowns> columns{};
  Residual residual{};
  Vector low, high;
  Decomposition decomposition;

  void setup() override {
    std::printf("seed 102 ");
    low.fill(-kFree);
    high.fill(kFree);
  }

  std::int16_t upTo(int most) {
    return static_cast<std::int16_t>(std::uniform_int_distribution<int>(-most, most)(random));
  }
  /// Columns at random, each longer than the last by some power of two.
  void fill(int unknowns) {
    for (int i = 0; i < unknowns; ++i)
      for (std::size_t row = 0; row < kRows; ++row) columns[at(i)][row] = upTo(4095 >> (i % 3));
    for (std::size_t row = 0; row < kRows; ++row) residual.value[row] = upTo(2000);
  }
  /// The last column is a sum of the others but for a part of it.
  void makeNearlyDependent(int unknowns, int part) {
    for (std::size_t row = 0; row < kRows; ++row) {
      int sum = 0;
      for (int i = 0; i + 1 < unknowns; ++i) sum += columns[at(i)][row];
      columns[at(unknowns - 1)][row] = static_cast<std::int16_t>(sum / unknowns + upTo(4096 / part));
    }
  }
  MatrixXd matrix(int unknowns) const {
    MatrixXd all(kRows, unknowns);
    for (Index i = 0; i < unknowns; ++i)
      for (Index row = 0; row < kRows; ++row) all(row, i) = columns[at(i)][at(row)];
    return all;
  }
  VectorXd rest() const {
    VectorXd all(kRows);
    for (Index row = 0; row < kRows; ++row) all[row] = std::ldexp(residual.value[at(row)], residual.shift);
    return all;
  }
  /// What each unknown comes to, given those behind it: from the last to the first, each within its limits.
  VectorXd expected(int unknowns) const {
    const MatrixXd all = matrix(unknowns);
    VectorXd left = rest(), x(unknowns);
    for (Index i = unknowns - 1; i >= 0; --i) {
      const VectorXd best = all.leftCols(i + 1).colPivHouseholderQr().solve(left);
      x[i] = std::clamp(best[i], std::ldexp(low[at(i)], -kStepBits), std::ldexp(high[at(i)], -kStepBits));
      left -= x[i] * all.col(i);
    }
    return x;
  }
  Step solved(int unknowns) {
    decompose(columns, kRows, unknowns, decomposition);
    return solve(decomposition, columns, kRows, residual, low, high);
  }
  /// Standard deviations of the unknowns for readings of standard deviation 1.
  static VectorXd sigmas(const MatrixXd& all) {
    return (all.transpose() * all).inverse().diagonal().cwiseSqrt();
  }
  /// Within `tolerance` of the standard deviation that the residuals give an unknown, and eight units of a
  /// step.
  void checkSolved(int unknowns, double tolerance) {
    const Step step = solved(unknowns);
    const VectorXd x = expected(unknowns), sigma = sigmas(matrix(unknowns));
    const double noise = rest().norm() / std::sqrt(kRows);
    for (Index i = 0; i < unknowns; ++i)
      DOUBLES_EQUAL(x[i], std::ldexp(step.x_q14[at(i)], -kStepBits),
                    std::ldexp(8, -kStepBits) + tolerance * noise * sigma[i]);
  }
  void checkReduction(int unknowns, double tolerance) {
    const Step step = solved(unknowns);
    const VectorXd left = rest() - matrix(unknowns) * expected(unknowns);
    const double reduction = rest().squaredNorm() - left.squaredNorm();
    DOUBLES_EQUAL(reduction, static_cast<double>(step.reduction), tolerance * rest().squaredNorm());
  }
};

TEST(NormalEquations, ReciprocalsAreRightTo28Bits) {
  const auto check = [](Number value) {
    const auto reciprocal = reciprocalOf(value);
    const double error = std::ldexp(reciprocal.mantissa, reciprocal.exponent) * value - 1;
    DOUBLES_EQUAL(0, error, std::ldexp(1, -28));
  };
  for (int bit = 0; bit < 31; ++bit)
    for (const int beside : {-1, 0, 1})
      if (const int value = (1 << bit) + beside; value > 0) check(value);
  check(0x7FFFFFFF);
  for (int i = 0; i < 100'000; ++i) check(static_cast<Number>((random() % 0x7FFFFFFE + 1) >> (i % 30)) | 1);
}

TEST(NormalEquations, StepsAreThoseOfLeastSquares) {
  for (int unknowns = 1; unknowns <= kMostUnknowns; ++unknowns)
    for (int i = 0; i < 200; ++i) {
      fill(unknowns);
      checkSolved(unknowns, 1e-3);
    }
}

TEST(NormalEquations, TheirReductionIsThatOfTheSquares) {
  for (int unknowns = 1; unknowns <= kMostUnknowns; ++unknowns)
    for (int i = 0; i < 200; ++i) {
      fill(unknowns);
      checkReduction(unknowns, 5e-4);
    }
}

TEST(NormalEquations, NearlyDependentColumnsAreSolvedToAPartOfTheirErrors) {
  for (const int part : {4, 8, 16, 24})
    for (int i = 0; i < 200; ++i) {
      fill(4);
      makeNearlyDependent(4, part);
      checkSolved(4, 0.01);
      checkReduction(4, 1e-3);
    }
}

TEST(NormalEquations, TinyAndHugeResidualsAreSolvedAlike) {
  for (int bits = 0; bits <= kColumnBits + kMostResidualShift; ++bits) {
    fill(4);
    residual.shift = std::max(bits - kColumnBits, 0);
    for (std::size_t row = 0; row < kRows; ++row) residual.value[row] = upTo(1 << (bits - residual.shift));
    checkSolved(4, 2e-3);
  }
}

TEST(NormalEquations, ReductionsOfTheLargestResidualsAreToldApart) {
  for (std::size_t row = 0; row < kRows; ++row) {
    columns[0][row] = 4095;
    residual.value[row] = row < 12 ? 4'000 : 0;
  }
  residual.shift = kMostResidualShift;
  checkReduction(1, 1e-3);  // 6e14: more than 32 bits
}

TEST(NormalEquations, AnUndeterminedUnknownKeepsItsValue) {
  for (int same = 1; same < 4; ++same) {
    fill(4);
    columns[at(same)] = columns[0];
    decompose(columns, kRows, 4, decomposition);
    for (int i = 0; i < 4; ++i) CHECK_EQUAL(i != same, decomposition.isDetermined(i));
    LONGS_EQUAL(0, solve(decomposition, columns, kRows, residual, low, high).x_q14[at(same)]);
    LONGS_EQUAL(0, variances(decomposition)[at(same)]);
  }
}

TEST(NormalEquations, TheOthersAreSolvedWithoutAnUndeterminedOne) {
  fill(4);
  columns[3] = columns[1];
  const Step step = solved(4);
  const VectorXd x = expected(3);
  for (Index i = 0; i < 3; ++i) DOUBLES_EQUAL(x[i], std::ldexp(step.x_q14[at(i)], -kStepBits), 1e-3);
}

TEST(NormalEquations, EmptyColumnsAreUndetermined) {
  columns = {};
  const Step step = solved(3);
  for (int i = 0; i < 3; ++i) {
    CHECK_FALSE(decomposition.isDetermined(i));
    LONGS_EQUAL(0, step.x_q14[at(i)]);
  }
  LONGS_EQUAL(0, step.reduction);
}

TEST(NormalEquations, AnUnknownAtItsLimitStaysThereAndTheOthersAreSolvedAnew) {
  for (int i = 0; i < 300; ++i) {
    fill(4);
    low[3] = -(1 << (random() % 12));
    high[3] = 1 << (random() % 12);
    high[2] = 1 << (random() % 14);
    low[2] = -high[2];
    checkSolved(4, 1e-3);
    checkReduction(4, 1e-3);
  }
}

TEST(NormalEquations, VariancesAreTheInversesDiagonal) {
  for (int unknowns = 1; unknowns <= kMostUnknowns; ++unknowns)
    for (int i = 0; i < 100; ++i) {
      fill(unknowns);
      decompose(columns, kRows, unknowns, decomposition);
      const auto variance = variances(decomposition);
      const VectorXd sigma = sigmas(matrix(unknowns));
      for (Index k = 0; k < unknowns; ++k)
        DOUBLES_EQUAL(1, std::sqrt(std::ldexp(static_cast<double>(variance[at(k)]), -50)) / sigma[k], 1e-3);
    }
}

TEST(NormalEquations, VariancesOfNearlyDependentColumnsAreRightToAPercent) {
  for (const int part : {4, 8, 16, 24}) {
    fill(4);
    makeNearlyDependent(4, part);
    decompose(columns, kRows, 4, decomposition);
    const VectorXd sigma = sigmas(matrix(4));
    for (Index k = 0; k < 4; ++k) {
      const auto variance = static_cast<double>(variances(decomposition)[at(k)]);
      DOUBLES_EQUAL(1, std::sqrt(std::ldexp(variance, -50)) / sigma[k], 0.01);
    }
  }
}
