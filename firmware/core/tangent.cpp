#include "firmware/core/tangent.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <limits>

#include "firmware/core/error_products.hpp"
#include "firmware/core/integer_root.hpp"

namespace strainfinger::firmware {
namespace {

/// Components of moves and residuals saturate here: the squares of eight fit 63 bits. They are so long only
/// where the readings left hardly determine them.
constexpr std::int64_t kLongest = (std::int64_t{1} << 30) - 1;

/// Fewer than this part of the information left is none, as a power of two.
constexpr int kDeterminedShift = 12;

int weight(const FoldedWeights& folded, int step) {
  if (step == 0) return folded[0];
  if (step > kWindowReach) return timesRootTwo<std::int32_t>(folded[kWindowGauges]);
  const auto distance = static_cast<std::size_t>(std::abs(step));
  return folded[distance] + (step > 0 ? 1 : -1) * folded[distance + kWindowReach];
}

struct WindowReadings {
  std::array<std::int16_t, kReadings> at{};
  std::int16_t last = kWindowReach;  ///< step
  std::uint16_t leftOut = 0;         ///< bit per index

  bool isLeftOut(int step) const { return (leftOut >> indexOf(step) & 1) != 0; }
  void leaveOut(int step) { leftOut = static_cast<std::uint16_t>(leftOut | 1u << indexOf(step)); }
};

/// Without either gauge the outer pair tells nothing.
[[gnu::noinline]] void readOuterPair(const Problem& problem, const RingSignal& signal, const View& view,
                                     int sign, WindowReadings& readings) {
  readings.last = kOuterReach;
  std::int32_t difference = 0;
  for (int side = -1; side <= 1; side += 2) {
    const int gauge = gaugeAt(problem, view, side * kOuterReach);
    if (contains(signal.leftOut, gauge)) return readings.leaveOut(kOuterReach);
    difference += side * signal.at(gauge);
  }
  readings.at[indexOf(kOuterReach)] = saturate<std::int16_t>(overRootTwo(sign * difference));
}

WindowReadings readingsOf(const Problem& problem, const RingSignal& signal, const View& view) {
  WindowReadings readings;
  const int sign = view.side > 0 ? 1 : problem.mirrorSign();
  for (int step = -kWindowReach; step <= kWindowReach; ++step) {
    const int gauge = gaugeAt(problem, view, step);
    readings.at[indexOf(step)] = saturate<std::int16_t>(sign * signal.at(gauge));
    if (contains(signal.leftOut, gauge)) readings.leaveOut(step);
  }
  if (hasOuterPair(problem.gauges())) readOuterPair(problem, signal, view, sign, readings);
  return readings;
}

/// Two loads, or their coefficients, and what is left of a 2 x 2 identity without some readings [* 2^15].
struct LoadPair {
  std::int32_t first = 0, second = 0;
  std::int32_t left11 = 1 << 15, left12 = 0, left22 = 1 << 15;

  std::int32_t determinant_q15() const {
    return static_cast<std::int32_t>((std::int64_t{left11} * left22 - std::int64_t{left12} * left12) >> 15);
  }
};

[[gnu::noinline]] LoadPair projected(const FitRow& row, const WindowReadings& readings) {
  LoadPair pair;
  for (int step = -kWindowReach; step <= readings.last; ++step) {
    const std::int32_t u1 = weight(row.basis[0], step), u2 = weight(row.basis[1], step);
    if (readings.isLeftOut(step)) {
      pair.left11 -= u1 * u1 >> 15;
      pair.left12 -= u1 * u2 >> 15;
      pair.left22 -= u2 * u2 >> 15;
    } else {
      pair.first += u1 * readings.at[indexOf(step)];
      pair.second += u2 * readings.at[indexOf(step)];
    }
  }
  return pair;
}

bool determined(std::int32_t determinant, int bits) { return determinant > 1 << (bits - kDeterminedShift); }

/// The loads' coefficients of the readings left [signal * 2^6].
std::array<std::int32_t, 2> solved(const LoadPair& pair) {
  const std::int64_t determinant = std::max<std::int32_t>(pair.determinant_q15(), 1);
  const auto coefficient = [&](std::int64_t numerator) {
    return saturate<std::int32_t>((numerator >> 9) / determinant);
  };
  return {coefficient(std::int64_t{pair.left22} * pair.first - std::int64_t{pair.left12} * pair.second),
          coefficient(std::int64_t{pair.left11} * pair.second - std::int64_t{pair.left12} * pair.first)};
}

/// Adds the direction of a move: W u.
[[gnu::noinline]] void addMove(const FitRow& row, const std::array<std::int32_t, 2>& loads, int last,
                               Tangent& tangent) {
  std::array<std::int32_t, kReadings> move{};
  std::int64_t energy = 0;
  for (int step = -kWindowReach; step <= last; ++step) {
    std::int64_t component = 0;
    for (std::size_t i = 0; i < 2; ++i)
      component += std::int64_t{weight(row.gradient[i], step)} *
                   ((std::int64_t{loads[i]} * row.gradient_length[i]) >> 15);
    component = std::clamp(component >> 15, -kLongest, kLongest);
    move[indexOf(step)] = static_cast<std::int32_t>(component);
    energy += component * component;
  }
  const int excess = 64 - std::countl_zero(static_cast<std::uint64_t>(energy)) - 30;
  const int halved = (excess + 1) >> 1;  // brings the length into [2^14, 2^15)
  const auto top = halved >= 0 ? energy >> (2 * halved) : energy << (-2 * halved);
  const auto length = static_cast<std::int32_t>(integerRoot(static_cast<std::uint32_t>(top)));
  if (energy == 0 || length == 0) return;
  for (std::size_t i = 0; i <= indexOf(last); ++i) {
    const std::int64_t scaled = halved >= 0 ? move[i] >> halved : std::int64_t{move[i]} * (1 << -halved);
    tangent.at[i][2] = saturate<std::int16_t>(static_cast<std::int32_t>(scaled) * (1 << 15) / length);
  }
  const int up = halved + row.gradient_exponent;
  tangent.steepness = up >= 0 ? std::int64_t{length} << up : std::int64_t{length} >> -up;
}

[[gnu::noinline]] void addLoads(const FitRow& row, int last, Tangent& tangent) {
  for (int step = -kWindowReach; step <= last; ++step)
    for (std::size_t i = 0; i < 2; ++i)
      tangent.at[indexOf(step)][i] = saturate<std::int16_t>(weight(row.basis[i], step));
}

constexpr int kMatrixBits = 24;

/// Product of two numbers * 2^24.
std::int64_t times(std::int64_t a, std::int64_t b) { return (a * b) >> kMatrixBits; }

/// What should be read at an index [signal * 2^4], as its view sees it.
std::int32_t predictedAt(const Tangent& tangent, const Three& coefficients, std::size_t index) {
  std::int64_t reading = 0;
  for (std::size_t k = 0; k < 3; ++k) reading += std::int64_t{tangent.at[index][k]} * coefficients[k];
  return saturate<std::int32_t>((reading + (1 << 14)) >> 15);
}

[[gnu::noinline]] void addEnergies(const Tangent& tangent, const WindowReadings& readings, Share& share) {
  std::int64_t window = 0, unexplained = 0;
  for (std::size_t i = 0; i <= indexOf(readings.last); ++i) {
    if ((readings.leftOut >> i & 1) != 0) continue;
    const std::int64_t reading = readings.at[i];
    const std::int64_t residual =
        std::clamp(reading * 16 - predictedAt(tangent, share.coefficients, i), -kLongest, kLongest);
    window += reading * reading;
    unexplained += residual * residual;
  }
  share.unexplained = saturate<std::int32_t>(unexplained >> 10);
  share.explained = saturate<std::int32_t>((window >> 2) - share.unexplained);
}

/// Without the four bits that a prediction has below a signal.
std::int32_t rounded(std::int32_t prediction) {
  return static_cast<std::int32_t>((std::int64_t{prediction} + 8) >> 4);
}

/// Sums over the readings left [signal * 2^4], and what they leave of an identity [* 2^24].
[[gnu::noinline]] Three sumsOf(const Tangent& tangent, const WindowReadings& readings, Symmetric& left) {
  constexpr std::int32_t kOne = 1 << kMatrixBits;
  left = {kOne, 0, 0, kOne, 0, kOne};
  Three sums{};
  for (std::size_t i = 0; i <= indexOf(readings.last); ++i) {
    const auto& e = tangent.at[i];
    std::size_t element = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if ((readings.leftOut >> i & 1) == 0) {
        sums[k] += e[k] * readings.at[i];
      } else {
        for (std::size_t j = k; j < 3; ++j) left[element++] -= e[k] * e[j] >> (30 - kMatrixBits);
      }
    }
  }
  for (std::int32_t& sum : sums) sum >>= 11;
  return sums;
}

[[gnu::noinline]] void fillShare(const Tangent& tangent, const WindowReadings& readings, Share& share) {
  const Three sums = sumsOf(tangent, readings, share.covariance_q12);
  share.determined = invert(share.covariance_q12, share.covariance_q12);
  if (!share.determined) return;
  share.coefficients = product_q12(share.covariance_q12, sums);
  share.outer = readings.at[indexOf(kOuterReach)];
  addEnergies(tangent, readings, share);
}

const FitRow& rowOf(const Problem& problem, const View& view) {
  return problem.tables.rows[static_cast<std::size_t>(view.row)];
}

}  // namespace

namespace {

/// The adjoint of a matrix, in its format, and the determinant.
[[gnu::noinline]] std::int32_t adjoin(const Symmetric& m, Symmetric& adjoint) {
  const std::int64_t a = m[0], b = m[1], c = m[2], d = m[3], e = m[4], f = m[5];
  adjoint = {narrowed(times(d, f) - times(e, e)), narrowed(times(c, e) - times(b, f)),
             narrowed(times(b, e) - times(c, d)), narrowed(times(a, f) - times(c, c)),
             narrowed(times(b, c) - times(a, e)), narrowed(times(a, d) - times(b, b))};
  return narrowed(times(a, adjoint[0]) + times(b, adjoint[1]) + times(c, adjoint[2]));
}

}  // namespace

std::int16_t scaledStrain(std::int32_t strain_q32, int up) {
  return saturate<std::int16_t>((std::int64_t{strain_q32} * (std::int64_t{1} << up) + (1 << 15)) >> 16);
}

[[gnu::noinline]] std::int32_t narrowed(std::int64_t value) { return saturate<std::int32_t>(value); }

bool invert(const Symmetric& matrix_q24, Symmetric& inverse_q12) {
  const std::int32_t determinant = adjoin(matrix_q24, inverse_q12);
  if (!determined(determinant, kMatrixBits)) return false;
  constexpr std::int64_t kLargest = std::int64_t{1} << kCovarianceBits;
  for (std::int32_t& element : inverse_q12)
    element = static_cast<std::int32_t>(
        std::clamp(std::int64_t{element} * (1 << 12) / determinant, -kLargest, kLargest));
  return true;
}

Three product_q12(const Symmetric& m, const Three& v) {
  const auto row = [&](std::size_t a, std::size_t b, std::size_t c) {
    return narrowed((std::int64_t{m[a]} * v[0] + std::int64_t{m[b]} * v[1] + std::int64_t{m[c]} * v[2]) >>
                    12);
  };
  return {row(0, 1, 2), row(1, 3, 4), row(2, 4, 5)};
}

int gaugeAt(const Problem& problem, const View& view, int step) {
  return wrapped(view.centre + view.side * step, problem.gauges());
}

View viewOf(const Problem& problem, PitchQ20 position) {
  const int nearest = (position + kOnePitch / 2) >> kPitchBits;
  const PitchQ20 offset = position - nearest * kOnePitch;
  const PitchQ20 distance = std::abs(offset);
  return {wrapped(nearest, problem.gauges()), offset < 0 ? -1 : 1, (distance + kRowSpacing / 2) >> kRowBits};
}

PitchQ20 Share::beyondRow(const Tangent& tangent) const {
  if (tangent.steepness == 0) return 0;
  constexpr std::int64_t kEighth = kOnePitch / 8;
  const std::int64_t length = std::int64_t{coefficients[2]} * (1 << (kPitchBits + 2)) / tangent.steepness;
  return static_cast<PitchQ20>(std::clamp(length, -kEighth, kEighth));
}

std::int32_t LocalFit::leverage_q15(int step) const {
  std::int32_t sum = 0;
  for (const std::int16_t each : tangent.at[indexOf(step)]) sum += each * each >> 15;
  return sum;
}

std::int32_t LocalFit::outerResidual() const {
  return share.outer - rounded(predictedAt(tangent, share.coefficients, indexOf(kOuterReach)));
}

std::int32_t LocalFit::predicted(const Problem& problem, const View& view, int step) const {
  const std::int32_t reading = rounded(predictedAt(tangent, share.coefficients, indexOf(step)));
  return view.side < 0 ? reading * problem.mirrorSign() : reading;
}

std::int32_t LocalFit::predicted_q32(const Problem& problem, const View& view, int step) const {
  std::int64_t reading = predictedAt(tangent, share.coefficients, indexOf(step));
  if (view.side < 0) reading *= problem.mirrorSign();
  const int up = 12 - problem.up;
  return saturate<std::int32_t>(up >= 0 ? reading * (std::int64_t{1} << up) : reading >> -up);
}

std::int32_t LocalFit::expected_q32(const Problem& problem, const RingSignal& signal, const View& view,
                                    int step) const {
  if (std::abs(step) <= kWindowReach) return predicted_q32(problem, view, step);
  const std::int64_t pair = timesRootTwo<std::int64_t>(predicted_q32(problem, view, kOuterReach));
  const std::int64_t more = step > 0 ? pair : -pair;
  const int other = gaugeAt(problem, view, -step);
  return saturate<std::int32_t>(
      contains(signal.leftOut, other) ? more / 2 : problem.strains[static_cast<std::size_t>(other)] + more);
}

LocalFit localFit(const Problem& problem, const RingSignal& signal, const View& view) {
  const FitRow& row = rowOf(problem, view);
  const WindowReadings readings = readingsOf(problem, signal, view);
  LocalFit fit;
  addLoads(row, readings.last, fit.tangent);
  addMove(row, solved(projected(row, readings)), readings.last, fit.tangent);
  fillShare(fit.tangent, readings, fit.share);
  return fit;
}

std::int32_t explainedAt(const Problem& problem, const RingSignal& signal, const View& view) {
  const LoadPair pair = projected(rowOf(problem, view), readingsOf(problem, signal, view));
  const std::int32_t determinant = pair.determinant_q15();
  if (!determined(determinant, 15)) return -1;
  const std::int64_t u1 = pair.first >> 15, u2 = pair.second >> 15;
  const std::int64_t energy =
      (u1 * u1 * pair.left22 - 2 * u1 * u2 * pair.left12 + u2 * u2 * pair.left11) >> 17;
  return saturate<std::int32_t>(energy * (1 << 15) / determinant);
}

}  // namespace strainfinger::firmware
