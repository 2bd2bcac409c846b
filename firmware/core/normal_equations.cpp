#include "firmware/core/normal_equations.hpp"

#include <algorithm>
#include <bit>

namespace strainfinger::firmware {
namespace {

constexpr int kUndeterminedBits = 12;
constexpr Number kMostLower = (1 << 30) - 1;
constexpr Number kMostStep = 1 << 28;
constexpr Number kMostGradient = 1 << 30;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// value / pivot * 2^bits, limited.
Number divided(Wide value, Decomposition::Reciprocal by, int bits, Number limit) {
  return shifted(value * by.mantissa, by.exponent + bits, limit);
}

}  // namespace

Decomposition::Reciprocal reciprocalOf(Number value) {
  const int up = std::countl_zero(static_cast<std::uint32_t>(value)) - 1;
  const auto normal = static_cast<std::uint32_t>(value) << up;             // in [2^30, 2^31)
  const std::uint32_t guess = (~std::uint32_t{0} / (normal >> 15)) << 14;  // 2^61 / normal, to 2^-15
  const std::uint64_t twice = (std::uint64_t{1} << 62) - std::uint64_t{normal} * guess;
  const auto mantissa = static_cast<std::uint32_t>((guess * (twice >> 31)) >> 30);  // one Newton step
  return {mantissa >> 1, static_cast<std::int8_t>(up - 60)};
}

void decompose(const std::array<Rows, kMostUnknowns>& columns, int rows, int unknowns,
               Decomposition& decomposition) {
  decomposition.unknowns = static_cast<std::uint8_t>(unknowns);
  for (int i = 0; i < unknowns; ++i) {
    Vector& lower = decomposition.lower_q20[at(i)];
    Vector scaledRow;  // L D
    const Number square = dot(columns[at(i)].data(), columns[at(i)].data(), rows);
    Wide pivot = square;
    for (int j = 0; j < i; ++j) {
      Wide rest = dot(columns[at(i)].data(), columns[at(j)].data(), rows);
      for (int m = 0; m < j; ++m)
        rest -= (Wide{decomposition.lower_q20[at(j)][at(m)]} * scaledRow[at(m)]) >> kLowerBits;
      scaledRow[at(j)] = limited(rest, kMostGradient);
      lower[at(j)] = divided(scaledRow[at(j)], decomposition.reciprocal[at(j)], kLowerBits, kMostLower);
      pivot -= (Wide{lower[at(j)]} * scaledRow[at(j)]) >> kLowerBits;
    }
    const bool isDetermined = pivot > square >> kUndeterminedBits && pivot > 0;
    decomposition.pivot[at(i)] = isDetermined ? static_cast<Number>(pivot) : 0;
    decomposition.reciprocal[at(i)] =
        isDetermined ? reciprocalOf(decomposition.pivot[at(i)]) : Decomposition::Reciprocal{};
  }
}

Step solve(const Decomposition& decomposition, const std::array<Rows, kMostUnknowns>& columns, int rows,
           const Rows& residual, const Vector& low_q14, const Vector& high_q14) {
  const int unknowns = decomposition.unknowns;
  std::array<Wide, kMostUnknowns> gradient;
  std::uint64_t bits = 0;
  for (int i = 0; i < unknowns; ++i) {
    gradient[at(i)] = wideDot(columns[at(i)].data(), residual.data(), rows);
    bits |= static_cast<std::uint64_t>(magnitude(gradient[at(i)]));
  }
  const int down = std::max(34 - std::countl_zero(bits), 0);  // to below 2^30
  Step step{};
  Vector z;
  Wide reduction = 0;  // [* 2^(14 - down)]
  Vector y;
  for (int i = 0; i < unknowns; ++i) {
    Wide rest = gradient[at(i)] >> down;
    for (int m = 0; m < i; ++m)
      rest -= (Wide{decomposition.lower_q20[at(i)][at(m)]} * y[at(m)]) >> kLowerBits;
    y[at(i)] = limited(rest, kMostGradient);
    z[at(i)] = divided(y[at(i)], decomposition.reciprocal[at(i)], kStepBits + down, kMostStep);
    if (decomposition.isDetermined(i)) reduction += Wide{y[at(i)]} * z[at(i)];
  }
  for (int i = unknowns - 1; i >= 0; --i) {
    Wide best = z[at(i)];
    for (int j = i + 1; j < unknowns; ++j)
      best -= (Wide{decomposition.lower_q20[at(j)][at(i)]} * step.x_q14[at(j)]) >> kLowerBits;
    if (!decomposition.isDetermined(i)) continue;
    const Number wanted = limited(best, kMostStep);
    const Number taken = std::clamp(wanted, low_q14[at(i)], high_q14[at(i)]);
    step.x_q14[at(i)] = taken;
    if (taken == wanted) continue;
    const Wide missed = limited(Wide{wanted} - taken, 1 << 24);
    const Wide lost =
        std::min<Wide>((magnitude(missed) * decomposition.pivot[at(i)]) >> kStepBits, Wide{1} << 34);
    reduction -= (lost * magnitude(missed)) >> down;
  }
  step.reduction = shifted(reduction, down - kStepBits, 0x7FFFFFFF);
  return step;
}

std::array<Wide, kMostUnknowns> variances(const Decomposition& decomposition) {
  constexpr int kVarianceBits = 50;
  const int unknowns = decomposition.unknowns;
  std::array<Wide, kMostUnknowns> variance{};
  for (int i = 0; i < unknowns; ++i) {
    if (!decomposition.isDetermined(i)) continue;
    // Column i of L^-1, below its 1 in row i.
    Vector inverse{};
    inverse[at(i)] = 1 << kLowerBits;
    for (int k = i; k < unknowns; ++k) {
      Wide rest = 0;
      for (int m = i; m < k; ++m)
        rest -= (Wide{decomposition.lower_q20[at(k)][at(m)]} * inverse[at(m)]) >> kLowerBits;
      if (k > i) inverse[at(k)] = limited(rest, kMostLower);
      if (!decomposition.isDetermined(k)) continue;
      const Wide square = (Wide{inverse[at(k)]} * inverse[at(k)]) >> kLowerBits;  // below 2^40, * 2^20
      const auto reciprocal = decomposition.reciprocal[at(k)];
      const int up = reciprocal.exponent + kVarianceBits - kLowerBits + 17;
      const Wide product = square * (reciprocal.mantissa >> 17);  // below 2^54
      variance[at(i)] +=
          up >= 0 ? std::min(product, Wide{1} << 54) << std::min(up, 4) : product >> std::min(-up, 63);
    }
  }
  return variance;
}

}  // namespace strainfinger::firmware
