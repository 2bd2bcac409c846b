#include "firmware/core/triple_fit.hpp"

#include "firmware/core/locate.hpp"
#include "firmware/core/scan.hpp"

namespace strainfinger::firmware {
namespace {

/// Three readings that lead farther than this from where all seven do are no better than the seven.
constexpr PitchQ20 kFarthest = kOnePitch / 16;

/// Cross product, / 2^15.
Vector3 cross(const Vector3& a, const Vector3& b) {
  return {(a[1] * b[2] - a[2] * b[1]) >> 15, (a[2] * b[0] - a[0] * b[2]) >> 15,
          (a[0] * b[1] - a[1] * b[0]) >> 15};
}

/// Where a gauge is in what was folded: at signed distance k from the middle, its part of a sum and of a
/// difference.
struct Unfolded {
  explicit Unfolded(int k)
      : even(static_cast<std::size_t>(absolute(k))),
        odd(k == 0 ? 7 : even + kWindowReach),
        sign(k < 0 ? -1 : 1) {}

  /// What folding halved: the gauge's weight in a column. The eighth number of a column is 0.
  std::int32_t of(const FoldedWeights& weights) const { return weights[even] + sign * weights[odd]; }
  /// Twice the gauge's reading, from numbers in the same order: sums are not means.
  std::int32_t twice(const std::array<std::int32_t, 8>& readings) const {
    return readings[even] + sign * readings[odd];
  }

  std::size_t even, odd;
  std::int32_t sign;
};

std::array<std::int32_t, 8> numbersOf(const Signal& signal) {
  const auto& [even, odd] = signal;
  return {2 * low(even[0]), high(even[0]), low(even[1]), high(even[1]),
          low(odd[0]),      high(odd[0]),  low(odd[1]),  0};
}

/// A row's weight [* 2^15] times a projection, doubled: as twiceReading().
std::int32_t twice(std::int32_t weight, std::int32_t projection) {
  return scaledByLow(projection, lowOnly(weight)) >> 13;
}

/// numerator / volume * 2^29, for a correction: of 15 digits, saturating at 2^30.
std::int32_t correction(std::int32_t numerator, std::int32_t volume) {
  return clipped<17>(numerator / (volume >> 15)) * (1 << 14);
}

/// A step from a row onto which the signal is projected.
bool takeTripleStep(const FitRow& row, WindowFit& fit) {
  const Projections& u = fit.step.projection;
  const TripleChoice choice = tripleChoice(row, u);
  const TripleSystem& system = choice.system;
  if (absolute(system.volume) < 1 << 16) return false;
  const std::array<std::int32_t, 8> numbers = numbersOf(fit.signal);
  Vector3 left;
  for (std::size_t i = 0; i < left.size(); ++i)
    left[i] = Unfolded(choice.gauges[i]).twice(numbers) - twice(choice.basis1[i], u[0]) -
              twice(choice.basis2[i], u[1]);
  const std::int32_t quotient = clipped<16>(inner(system.forOffset, left) / (system.volume >> 13));
  fit.step.projection = {u[0] + correction(inner(system.forProjection1, left), system.volume),
                         u[1] + correction(inner(system.forProjection2, left), system.volume)};
  fit.step.length = clipped<kPitchBits - 2>((quotient * 512) >> (row.gradient_exponent + 3));
  return true;
}

/// The window fit that a fit of seven readings came from.
WindowFit windowFitOf(const TableImage& tables, const std::int32_t* strains_q32, const Fit& fit) {
  WindowFit window;
  const TableConstants& constants = tables.constants;
  const PitchQ20 offset = fit.offset(constants.gauge_count);
  const int row = static_cast<int>(fit.row - tables.rows.data());
  const Signal signal = windowSignal({strains_q32, constants.gauge_count}, fit.centre, fit.up);
  window.centre = fit.centre;
  window.side = offset < 0 ? -1 : 1;
  window.row = row;
  window.signal = offset < 0 ? mirrored(signal, constants.mirror_sign) : signal;
  window.step.projection =
      projectionsOn(*fit.row, window.signal);  // the fit may have crossed the middle gauge
  window.step.length = absolute(offset) - row * kRowSpacing;
  return window;
}

[[gnu::noinline]] void leaveToThree(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32) {
  WindowFit window = windowFitOf(tables, strains_q32, fit);
  if (!solveTriple(tables.rows, tables.constants.mirror_sign, window)) return;
  const bool alone = fit.alternative == fit.best;
  fit.row = unknown(tables.rows.data()) + window.row;
  const Amplitudes amplitudes = amplitudesOf(*fit.row, window.step);
  fit.best = {roundTheRing(window.position(), tables.constants.gauge_count), amplitudes.normal,
              window.side * amplitudes.tangential};
  if (alone) fit.alternative = fit.best;
  fit.projection = window.step.projection;
  fit.readings = FitMode::kThreePoint;
}

}  // namespace

TripleChoice tripleChoice(const FitRow& row, const Projections& projection) {
  const Pair weighted = weightedBy(row, projection);
  TripleChoice choice;
  choice.gauges = kTripleList[row.triple[projection[1] < 0 ? kAgainstOffset : kWithOffset]];
  Vector3 gradient;
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    const Unfolded gauge(choice.gauges[i]);
    choice.basis1[i] = gauge.of(row.basis[0]);
    choice.basis2[i] = gauge.of(row.basis[1]);
    gradient[i] =
        (gauge.of(row.gradient[0]) * low(weighted) + gauge.of(row.gradient[1]) * high(weighted)) >> 13;
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
  const PitchQ20 before = fit.side * fit.offset();
  for (int left = kMaxSteps; left > 0; --left) {
    follow(fit, fit.step.length, mirrorSign);
    const FitRow& row = *unknown(unknown(rows.data()) + fit.row);
    fit.step.projection = projectionsOn(row, fit.signal);
    if (!takeTripleStep(row, fit)) return false;
    if (absolute(fit.side * fit.offset() - before) > kFarthest) return false;
    if (absolute(fit.step.length) <= kRowSpacing) return true;
  }
  return false;
}

void locateByThree(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32,
                   std::uint32_t energy) {
  locateBySeven(fit, tables, strains_q32, energy);
  if (fit.settled) leaveToThree(fit, tables, strains_q32);
}

}  // namespace strainfinger::firmware
