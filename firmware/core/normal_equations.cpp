#include "firmware/core/normal_equations.hpp"

#include <algorithm>

namespace strainfinger::firmware {
namespace {

constexpr int kUndeterminedBits = 12;
constexpr int kSumBits = kColumnBits + kColumnBits + 5;  ///< of a sum of 32 products of columns and residuals
constexpr int kLowerLimitBits = 30;
constexpr int kInverseLimitBits = 29;

/// Scalar product of the first `last` entries of a row of L and a vector: at most seven products below 2^60.
Number product(const Number* lower_q20, const Vector& vector, int last) {
  Wide sum = 0;
  for (int m = 0; m < last; ++m) sum += Wide{lower_q20[m]} * vector[index(m)];
  return narrowed<kLowerBits, kSumBits>(sum);
}

}  // namespace

void decompose(const std::array<Rows, kMostUnknowns>& columns, int rows, int unknowns,
               Decomposition& decomposition) {
  decomposition.unknowns = static_cast<std::uint8_t>(unknowns);
  for (int i = 0; i < unknowns; ++i) {
    Number* const lower = decomposition.lower(i);
    Vector scaledRow;  // L D
    const Short* const column = columns[index(i)].data();
    for (int j = 0; j < i; ++j) {
      const Number rest =
          dot(column, columns[index(j)].data(), rows) - product(decomposition.lower(j), scaledRow, j);
      scaledRow[index(j)] = rest;
      lower[j] = divided(rest, decomposition.reciprocal[index(j)], kLowerBits, 1 << kLowerLimitBits);
    }
    const Number square = dot(column, column, rows);
    const Number pivot = square - product(lower, scaledRow, i);
    const bool isDetermined = pivot > square >> kUndeterminedBits && pivot > 0;
    decomposition.pivot[index(i)] = isDetermined ? pivot : 0;
    decomposition.reciprocal[index(i)] =
        isDetermined ? reciprocalOf(decomposition.pivot[index(i)]) : Reciprocal{};
  }
}

Step solve(const Decomposition& decomposition, const std::array<Rows, kMostUnknowns>& columns, int rows,
           const Residual& residual, const Vector& low_q14, const Vector& high_q14) {
  const int unknowns = decomposition.unknowns;
  Step step;
  Wide reduction = 0;  // [* 2^(14 - shift)]
  Vector y, z;
  for (int i = 0; i < unknowns; ++i) {
    y[index(i)] =
        dot(columns[index(i)].data(), residual.value.data(), rows) - product(decomposition.lower(i), y, i);
    z[index(i)] = divided(y[index(i)], decomposition.reciprocal[index(i)], kStepBits + residual.shift,
                          1 << kStepLimitBits);
    if (decomposition.isDetermined(i)) reduction += Wide{y[index(i)]} * z[index(i)];
  }
  for (int i = unknowns - 1; i >= 0; --i) {
    step.x_q14[index(i)] = 0;
    if (!decomposition.isDetermined(i)) continue;
    Wide sum_q20 = 0;
    for (int j = i + 1; j < unknowns; ++j) sum_q20 += Wide{decomposition.lower(j)[i]} * step.x_q14[index(j)];
    const Number wanted = z[index(i)] - narrowed<kLowerBits, kStepLimitBits>(sum_q20);
    const Number taken = clamped(wanted, low_q14[index(i)], high_q14[index(i)]);
    step.x_q14[index(i)] = taken;
    if (taken == wanted) continue;
    const Wide missed = limited(Wide{wanted} - taken, 1 << 24);
    const Wide lost = lesser((magnitude(missed) * decomposition.pivot[index(i)]) >> kStepBits, Wide{1} << 34);
    reduction -= (lost * magnitude(missed)) >> residual.shift;
  }
  step.reduction = reduction >> (kStepBits - residual.shift);
  return step;
}

std::array<Wide, kMostUnknowns> variances(const Decomposition& decomposition) {
  constexpr int kInverseBits = 40, kSpareBits = 10;
  const int unknowns = decomposition.unknowns;
  // 1 / pivot, limited to 2^-10. A column scaled to use its 12 bits has a pivot above 2^10. The loads'
  // columns have a fixed scale and may have lower pivots where weights are small; these count as 2^10.
  Vector weight_q40;
  for (int i = 0; i < unknowns; ++i) {
    const Reciprocal& reciprocal = decomposition.reciprocal[index(i)];
    weight_q40[index(i)] =
        (shifted(reciprocal.mantissa, reciprocal.exponent + kInverseBits + 1, 0x7FFFFFFE) + 1) >> 1;
  }
  std::array<Wide, kMostUnknowns> variance;
  for (int i = 0; i < unknowns; ++i) {
    // Column i of L^-1, below its 1 in row i.
    Vector inverse;
    inverse[index(i)] = 1 << kLowerBits;
    variance[index(i)] = Wide{weight_q40[index(i)]} << kSpareBits;
    for (int k = i + 1; k < unknowns; ++k) {
      Wide sum_q20 = 0;
      for (int m = i; m < k; ++m) sum_q20 -= Wide{decomposition.lower(k)[m]} * inverse[index(m)];
      inverse[index(k)] = narrowed<kLowerBits, kInverseLimitBits>(sum_q20);
      const Wide square_q20 = squareOf(inverse[index(k)]) >> kLowerBits;
      variance[index(i)] += (square_q20 >> kSpareBits) * weight_q40[index(k)] +
                            ((Wide{lowBits<kSpareBits>(square_q20)} * weight_q40[index(k)]) >> kSpareBits);
    }
    if (!decomposition.isDetermined(i)) variance[index(i)] = 0;
  }
  return variance;
}

}  // namespace strainfinger::firmware
