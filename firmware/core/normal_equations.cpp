#include "firmware/core/normal_equations.hpp"

#include <algorithm>
#include <bit>

namespace strainfinger::firmware {
namespace {

constexpr int kUndeterminedBits = 12;
constexpr int kLowerLimitBits = 30;
constexpr int kStepLimitBits = 28;
constexpr int kGradientLimitBits = 30;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Sum of L's row and a vector, first .. last - 1 [* 2^kLowerBits]: seven products below 2^60.
Wide product(const Vector& lower_q20, const Vector& vector, int last) {
  Wide sum = 0;
  for (int m = 0; m < last; ++m) sum += Wide{lower_q20[at(m)]} * vector[at(m)];
  return sum;
}

}  // namespace

void decompose(const std::array<Rows, kMostUnknowns>& columns, int rows, int unknowns,
               Decomposition& decomposition) {
  decomposition.unknowns = static_cast<std::uint8_t>(unknowns);
  for (int i = 0; i < unknowns; ++i) {
    Vector& lower = decomposition.lower_q20[at(i)];
    Vector scaledRow;  // L D
    const Number square = dot(columns[at(i)].data(), columns[at(i)].data(), rows);
    Wide pivot_q20 = Wide{square} << kLowerBits;
    for (int j = 0; j < i; ++j) {
      const Wide entry_q20 = Wide{dot(columns[at(i)].data(), columns[at(j)].data(), rows)} << kLowerBits;
      const Wide rest_q20 = entry_q20 - product(decomposition.lower_q20[at(j)], scaledRow, j);
      scaledRow[at(j)] = narrowed<kLowerBits, kGradientLimitBits>(rest_q20);
      lower[at(j)] =
          divided(scaledRow[at(j)], decomposition.reciprocal[at(j)], kLowerBits, 1 << kLowerLimitBits);
      pivot_q20 -= Wide{lower[at(j)]} * scaledRow[at(j)];
    }
    const Wide pivot = pivot_q20 >> kLowerBits;
    const bool isDetermined = pivot > square >> kUndeterminedBits && pivot > 0;
    decomposition.pivot[at(i)] = isDetermined ? saturate<Number>(pivot) : 0;
    decomposition.reciprocal[at(i)] = isDetermined ? reciprocalOf(decomposition.pivot[at(i)]) : Reciprocal{};
  }
}

Step solve(const Decomposition& decomposition, const std::array<Rows, kMostUnknowns>& columns, int rows,
           const Rows& residual, const Vector& low_q14, const Vector& high_q14) {
  const int unknowns = decomposition.unknowns;
  std::array<Wide, kMostUnknowns> gradient;
  Wide bits = 0;
  for (int i = 0; i < unknowns; ++i) {
    gradient[at(i)] = wideDot(columns[at(i)].data(), residual.data(), rows);
    bits |= magnitude(gradient[at(i)]);
  }
  const int down = std::max(bitWidth(bits) - 30, 0);  // to below 2^30
  Step step;
  Vector z;
  Wide reduction = 0;  // [* 2^(14 - down)]
  Vector y;
  for (int i = 0; i < unknowns; ++i) {
    const Wide given_q20 = (gradient[at(i)] >> down) << kLowerBits;
    const Wide rest_q20 = given_q20 - product(decomposition.lower_q20[at(i)], y, i);
    y[at(i)] = narrowed<kLowerBits, kGradientLimitBits>(rest_q20);
    z[at(i)] = divided(y[at(i)], decomposition.reciprocal[at(i)], kStepBits + down, 1 << kStepLimitBits);
    if (decomposition.isDetermined(i)) reduction += Wide{y[at(i)]} * z[at(i)];
  }
  for (int i = unknowns - 1; i >= 0; --i) {
    step.x_q14[at(i)] = 0;
    if (!decomposition.isDetermined(i)) continue;
    Wide best_q20 = Wide{z[at(i)]} << kLowerBits;
    for (int j = i + 1; j < unknowns; ++j)
      best_q20 -= Wide{decomposition.lower_q20[at(j)][at(i)]} * step.x_q14[at(j)];
    const Number wanted = narrowed<kLowerBits, kStepLimitBits>(best_q20);
    const Number taken = clamped(wanted, low_q14[at(i)], high_q14[at(i)]);
    step.x_q14[at(i)] = taken;
    if (taken == wanted) continue;
    const Wide missed = limited(Wide{wanted} - taken, 1 << 24);
    const Wide lost = lesser((magnitude(missed) * decomposition.pivot[at(i)]) >> kStepBits, Wide{1} << 34);
    reduction -= (lost * magnitude(missed)) >> down;
  }
  step.reduction = reduction >> (kStepBits - down);  // gradients have 34 bits at most: down <= 4
  return step;
}

std::array<Wide, kMostUnknowns> variances(const Decomposition& decomposition) {
  constexpr int kVarianceBits = 50;
  const int unknowns = decomposition.unknowns;
  std::array<Wide, kMostUnknowns> variance{};
  for (int i = 0; i < unknowns; ++i) {
    if (!decomposition.isDetermined(i)) continue;
    // Column i of L^-1, below its 1 in row i.
    Vector inverse;
    inverse[at(i)] = 1 << kLowerBits;
    for (int k = i; k < unknowns; ++k) {
      Wide rest_q20 = 0;
      for (int m = i; m < k; ++m) rest_q20 -= Wide{decomposition.lower_q20[at(k)][at(m)]} * inverse[at(m)];
      if (k > i) inverse[at(k)] = narrowed<kLowerBits, kLowerLimitBits>(rest_q20);
      if (!decomposition.isDetermined(k)) continue;
      const Wide square = squareOf(inverse[at(k)]) >> kLowerBits;  // below 2^40, * 2^20
      const auto reciprocal = decomposition.reciprocal[at(k)];
      const Number up = reciprocal.exponent + kVarianceBits - kLowerBits + 17;
      const Wide product = square * (reciprocal.mantissa >> 17);  // below 2^54
      variance[at(i)] += shiftedAtMost(product, up, 4);
    }
  }
  return variance;
}

}  // namespace strainfinger::firmware
