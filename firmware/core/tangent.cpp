#include "firmware/core/tangent.hpp"

#include <cstdlib>

namespace strainfinger::firmware {
namespace {

struct WindowReadings {
  std::array<Short, kReadings> at{};
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
  readings.at[indexOf(kOuterReach)] = outerReading(sign * difference);
}

WindowReadings readingsOf(const Problem& problem, const RingSignal& signal, const View& view) {
  WindowReadings readings;
  const int sign = view.side > 0 ? 1 : problem.mirrorSign();
  for (int step = -kWindowReach; step <= kWindowReach; ++step) {
    const int gauge = gaugeAt(problem, view, step);
    readings.at[indexOf(step)] = static_cast<Short>(clipped<16>(sign * signal.at(gauge)));
    if (contains(signal.leftOut, gauge)) readings.leaveOut(step);
  }
  if (hasOuterPair(problem.gauges())) readOuterPair(problem, signal, view, sign, readings);
  return readings;
}

[[gnu::noinline]] LoadPair projected(const FitRow& row, const WindowReadings& readings) {
  LoadPair pair;
  for (int step = -kWindowReach; step <= readings.last; ++step) {
    const std::int32_t weight1 = weightAt(row.basis[0], step), weight2 = weightAt(row.basis[1], step);
    if (readings.isLeftOut(step)) {
      pair.leaveOut(weight1, weight2);
    } else {
      pair.add(weight1, weight2, readings.at[indexOf(step)]);
    }
  }
  return pair;
}

/// Adds the direction of a move: W u.
[[gnu::noinline]] void addMove(const FitRow& row, const std::array<std::int32_t, 2>& loads, int last,
                               Tangent& tangent) {
  std::array<std::int32_t, kReadings> move{};
  std::uint64_t energy = 0;
  for (int step = -kWindowReach; step <= last; ++step) {
    const std::int32_t component = moveAt(row, loads, step);
    move[indexOf(step)] = component;
    energy += squared(component);
  }
  const MoveLength length(energy);
  if (length.root == 0) return;
  for (std::size_t i = 0; i <= indexOf(last); ++i) tangent.at[i][2] = length.direction(move[i]);
  tangent.steepness = length.steepness(row.gradient_exponent);
}

[[gnu::noinline]] void addLoads(const FitRow& row, int last, Tangent& tangent) {
  for (int step = -kWindowReach; step <= last; ++step)
    for (std::size_t i = 0; i < 2; ++i)
      tangent.at[indexOf(step)][i] = static_cast<Short>(clipped<16>(weightAt(row.basis[i], step)));
}

/// What should be read at an index [signal * 2^4], as its view sees it.
std::int32_t predictedAt(const Tangent& tangent, const Three& coefficients, std::size_t index) {
  return predictedFrom(tangent.at[index], coefficients);
}

[[gnu::noinline]] void addEnergies(const Tangent& tangent, const WindowReadings& readings, Share& share) {
  SquareSums sums;
  for (std::size_t i = 0; i <= indexOf(readings.last); ++i)
    if ((readings.leftOut >> i & 1) == 0)
      sums.add(readings.at[i], predictedAt(tangent, share.coefficients, i));
  share.unexplained = sums.unexplained();
  share.explained = sums.explained();
}

/// Sums over the readings left [signal * 2^4], and what they leave of an identity [* 2^24].
[[gnu::noinline]] Three sumsOf(const Tangent& tangent, const WindowReadings& readings, Symmetric& left) {
  constexpr std::int32_t kOne = 1 << kMatrixBits;
  left = {kOne, 0, 0, kOne, 0, kOne};
  Three sums{};
  for (std::size_t i = 0; i <= indexOf(readings.last); ++i) {
    if ((readings.leftOut >> i & 1) == 0) {
      addAlong(sums, tangent.at[i], readings.at[i]);
    } else {
      takeOut(left, tangent.at[i]);
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

bool invert(const Symmetric& matrix_q24, Symmetric& inverse_q12) {
  const std::int32_t determinant = adjoin(matrix_q24, inverse_q12);
  if (determinant <= mostUndetermined(kMatrixBits)) return false;
  divideBy(determinant, inverse_q12);
  return true;
}

int gaugeAt(const Problem& problem, const View& view, int step) {
  return wrapped(view.centre + view.side * step, problem.gauges());
}

View viewOf(const Problem& problem, PitchQ20 position) {
  const int nearest = nearestGauge(position);
  const PitchQ20 offset = offsetFrom(nearest, position);
  return {wrapped(nearest, problem.gauges()), offset < 0 ? -1 : 1, nearestRowTo(offset)};
}

PitchQ20 Share::beyondRow(const Tangent& tangent) const {
  if (tangent.steepness == 0) return 0;
  return lengthBeyond(coefficients[2], tangent.steepness);
}

std::int32_t LocalFit::leverage_q15(int step) const {
  return firmware::leverage_q15(tangent.at[indexOf(step)]);
}

std::int32_t LocalFit::outerResidual() const {
  return share.outer - wholeReading(predictedAt(tangent, share.coefficients, indexOf(kOuterReach)));
}

std::int32_t LocalFit::predicted(const Problem& problem, const View& view, int step) const {
  const std::int32_t reading = wholeReading(predictedAt(tangent, share.coefficients, indexOf(step)));
  return view.side < 0 ? reading * problem.mirrorSign() : reading;
}

std::int32_t LocalFit::predicted_q32(const Problem& problem, const View& view, int step) const {
  std::int64_t reading = predictedAt(tangent, share.coefficients, indexOf(step));
  if (view.side < 0) reading *= problem.mirrorSign();
  return predictedStrain(reading, problem.up);
}

std::int32_t LocalFit::expected_q32(const Problem& problem, const RingSignal& signal, const View& view,
                                    int step) const {
  if (std::abs(step) <= kWindowReach) return predicted_q32(problem, view, step);
  const std::int64_t pair = timesRootTwo<std::int64_t>(predicted_q32(problem, view, kOuterReach));
  const std::int64_t more = step > 0 ? pair : -pair;
  const int other = gaugeAt(problem, view, -step);
  return contains(signal.leftOut, other)
             ? saturated(more / 2)
             : besideOther(problem.strains[static_cast<std::size_t>(other)], more);
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
  if (determinant <= mostUndetermined(15)) return -1;
  return explainedBy(pair, determinant);
}

}  // namespace strainfinger::firmware
