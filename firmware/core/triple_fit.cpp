#include "firmware/core/triple_fit.hpp"

namespace strainfinger::firmware {
namespace {

/// Three readings that lead farther than this from where all seven do are no better than the seven.
constexpr PitchQ20 kFarthest = kOnePitch / 16;

/// Cross product, / 2^15.
Vector3 cross(const Vector3& a, const Vector3& b) {
  return {(a[1] * b[2] - a[2] * b[1]) >> 15, (a[2] * b[0] - a[0] * b[2]) >> 15,
          (a[0] * b[1] - a[1] * b[0]) >> 15};
}

/// What folding halved: the weight of one gauge, at signed distance k from the middle.
std::int32_t unfolded(const FoldedWeights& weights, int k) {
  if (k == 0) return weights[0];
  const auto distance = static_cast<std::size_t>(absolute(k));
  const std::int32_t difference = weights[distance + kWindowReach];
  return weights[distance] + (k > 0 ? difference : -difference);
}

/// Twice the reading of a gauge: folded signals are sums, not means.
std::int32_t twiceReading(const Signal& signal, int k) {
  const std::array<std::int32_t, 4> sums{low(signal.even[0]), high(signal.even[0]), low(signal.even[1]),
                                         high(signal.even[1])};
  const std::array<std::int32_t, 4> differences{0, low(signal.odd[0]), high(signal.odd[0]),
                                                low(signal.odd[1])};
  if (k == 0) return 2 * sums[0];
  const auto distance = static_cast<std::size_t>(absolute(k));
  return sums[distance] + (k > 0 ? differences[distance] : -differences[distance]);
}

/// A row's weight [* 2^15] times a projection, doubled: as twiceReading().
std::int32_t twice(std::int32_t weight, std::int32_t projection) {
  return scaledByLow(projection, lowOnly(weight)) >> 13;
}

/// numerator / volume * 2^29, for a correction: of 15 digits, saturating at 2^30.
std::int32_t correction(std::int32_t numerator, std::int32_t volume) {
  return clipped<17>(numerator / (volume >> 15)) * (1 << 14);
}

bool step(const FitRow& row, WindowFit& fit) {
  const Projections u = projectionsOn(row, fit.signal);
  const TripleChoice choice = tripleChoice(row, u);
  const TripleSystem& system = choice.system;
  if (absolute(system.volume) < 1 << 16) return false;
  Vector3 left;
  for (std::size_t i = 0; i < left.size(); ++i)
    left[i] = twiceReading(fit.signal, choice.gauges[i]) - twice(choice.basis1[i], u[0]) -
              twice(choice.basis2[i], u[1]);
  const std::int32_t quotient = clipped<16>(inner(system.forOffset, left) / (system.volume >> 13));
  fit.step.projection = {u[0] + correction(inner(system.forProjection1, left), system.volume),
                         u[1] + correction(inner(system.forProjection2, left), system.volume)};
  fit.step.length = clipped<kPitchBits - 2>((quotient * 512) >> (row.gradient_exponent + 3));
  return true;
}

}  // namespace

TripleChoice tripleChoice(const FitRow& row, const Projections& projection) {
  const Pair weighted = weightedBy(row, projection);
  TripleChoice choice;
  choice.gauges = kTripleList[row.triple[projection[1] < 0 ? kAgainstOffset : kWithOffset]];
  Vector3 gradient;
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    const int k = choice.gauges[i];
    choice.basis1[i] = unfolded(row.basis[0], k);
    choice.basis2[i] = unfolded(row.basis[1], k);
    gradient[i] =
        (unfolded(row.gradient[0], k) * low(weighted) + unfolded(row.gradient[1], k) * high(weighted)) >> 13;
  }
  choice.system = {.forOffset = cross(choice.basis1, choice.basis2),
                   .forProjection1 = cross(choice.basis2, gradient),
                   .forProjection2 = cross(gradient, choice.basis1),
                   .volume = 0};
  choice.system.volume = inner(choice.system.forOffset, gradient);
  return choice;
}

bool solveTriple(const FitTable& rows, int mirrorSign, WindowFit& fit) {
  constexpr int kMaxSteps = 3;
  const PitchQ20 before = fit.position();
  for (int count = 0; count < kMaxSteps; ++count) {
    follow(fit, fit.step.length, mirrorSign);
    if (!step(rows[static_cast<std::size_t>(fit.row)], fit)) return false;
    if (absolute(fit.position() - before) > kFarthest) return false;
    if (absolute(fit.step.length) <= kRowSpacing) return true;
  }
  return isConverged(fit.step.length);
}

}  // namespace strainfinger::firmware
