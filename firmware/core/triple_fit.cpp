#include "firmware/core/triple_fit.hpp"

#include <algorithm>

#include "firmware/core/locate.hpp"
#include "firmware/core/near_triple.hpp"
#include "firmware/core/scan.hpp"

namespace strainfinger::firmware {
namespace {

/// Three readings that lead farther than this from where all seven do are no better than the seven.
constexpr PitchQ20 kFarthest = kOnePitch / 16;

/// The row's best conditioned triple: by the second projection, which has the sign of the tangential load.
std::uint8_t tripleAt(const FitRow& row, const Projections& projection) {
  return row.triple[projection[1] < 0 ? kAgainstOffset : kWithOffset];
}

/// A step from a row onto which the signal is projected.
bool takeTripleStep(const FitRow& row, std::uint8_t triple, WindowFit& fit) {
  const Projections u = fit.step.projection;
  const TripleSystem system = systemOf(row, triple, u);
  if (absolute(system.volume) < 1 << 16) return false;
  fit.step = tripleStep(row, system, twiceRead(fit.signal, kTripleList[triple]), u);
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

/// The best answer, and its own alternative if there was no other.
[[gnu::always_inline]] inline void replaceBest(Fit& fit, const Placement& best) {
  if (fit.alternative.position == fit.best.position) fit.alternative = best;
  fit.best = best;
}

[[gnu::noinline]] void leaveToThree(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32) {
  WindowFit window = windowFitOf(tables, strains_q32, fit);
  const auto triple = solveTriple(tables.rows, tables.constants.mirror_sign, window);
  if (!triple) return;
  fit.row = unknown(tables.rows.data()) + window.row;
  const Amplitudes amplitudes = amplitudesOf(*fit.row, window.step);
  replaceBest(fit, {roundTheRing(window.position(), tables.constants.gauge_count), amplitudes.normal,
                    window.side * amplitudes.tangential});
  fit.projection = window.step.projection;
  fit.readings = FitMode::kThreePoint;
  fit.triple = *triple;
}

/// Middle reading and the two beside it, as a fit's side sees them.
NearSignal nearSignalOf(const TableConstants& constants, const std::int32_t* strains_q32, const Fit& fit,
                        int side) {
  const int gauges = constants.gauge_count;
  return seenFrom(nearSignal(strains_q32[wrapped(fit.centre - 1, gauges)], strains_q32[fit.centre],
                             strains_q32[wrapped(fit.centre + 1, gauges)], fit.up),
                  side, constants.mirror_sign);
}

/// From the middle between two rows: as far as a straight line between their distances holds.
constexpr PitchQ20 kBetweenRows = kRowSpacing * 3 / 4;

/// Leaves the answer to the three nearest readings, between the two rows around it. False: they tell it with
/// more than sqrt(2) times the error of all seven, or lead away.
[[gnu::noinline]] bool leaveToNear(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32) {
  constexpr int kBits = kRowBits + kRowStrideBits, kLast = ((kFitRows - 1) >> kRowStrideBits) - 1;
  const TableConstants& constants = tables.constants;
  const PitchQ20 offset = fit.offset(constants.gauge_count);
  const int side = offset < 0 ? -1 : 1;
  const NearSignal signal = nearSignalOf(constants, strains_q32, fit, side);
  const FitRow* const rows = unknown(tables.rows.data());
  int pair = std::min<int>(absolute(offset) >> kBits, kLast);
  for (bool again = false;; again = true) {
    const FitRow& row = *unknown(rows + (pair << kRowStrideBits));
    const FitRow& next = *(&row + (1 << kRowStrideBits));
    const NearColumns columns = nearColumns(row), nextColumns = nearColumns(next);
    const NearNormal normal = nearNormal(row, columns), nextNormal = nearNormal(next, nextColumns);
    const std::int32_t distance = distanceFrom(normal, signal);
    const std::int32_t closer = distance - distanceFrom(nextNormal, signal);
    const std::int32_t beyond = secantLength(distance, closer);
    if (absolute(beyond - kRowSpacing / 2) > kBetweenRows) {
      pair += beyond >> kRowBits;
      if (again || pair < 0 || pair > kLast) return false;
      continue;
    }
    if (closerSquared(*fit.row, closer) < leastCloser(normal, fit.information)) return false;
    const NearQuotients quotients = between(nearQuotients(columns, normal.sum, signal),
                                            nearQuotients(nextColumns, nextNormal.sum, signal), beyond);
    if (absolute(quotients.divisor) < kLeastDivisor) return false;
    fit.projection = nearProjections(quotients);
    fit.row = beyond > kRowSpacing / 2 ? &next : &row;
    const Amplitudes amplitudes = nearAmplitudes(row, next, fit.projection, beyond);
    const PitchQ20 found = (pair << kBits) + (beyond << kRowStrideBits);
    replaceBest(fit, {roundTheRing(fit.centre * kOnePitch + side * found, constants.gauge_count),
                      amplitudes.normal, side * amplitudes.tangential});
    break;
  }
  fit.readings = FitMode::kThreePoint;
  fit.triple = kNearTriple;
  return true;
}

}  // namespace

TripleSystem systemOf(const FitRow& row, std::uint8_t triple, const Projections& projection) {
  return tripleSystem(row, kTripleList[triple], projection);
}

std::optional<std::uint8_t> solveTriple(const FitTable& rows, int mirrorSign, WindowFit& fit) {
  constexpr int kMaxSteps = 3;
  const PitchQ20 before = fit.side * fit.offset();
  for (int left = kMaxSteps; left > 0; --left) {
    follow(fit, fit.step.length, mirrorSign);
    const FitRow& row = *unknown(unknown(rows.data()) + fit.row);
    fit.step.projection = projectionsOn(row, fit.signal);
    const std::uint8_t triple = tripleAt(row, fit.step.projection);
    if (!takeTripleStep(row, triple, fit)) return {};
    if (absolute(fit.side * fit.offset() - before) > kFarthest) return {};
    if (absolute(fit.step.length) <= kRowSpacing << kRowStrideBits) return triple;
  }
  return {};
}

void locateByThree(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32,
                   std::uint32_t energy) {
  locateBySeven(fit, tables, strains_q32, energy);
  if (fit.settled && !leaveToNear(fit, tables, strains_q32)) leaveToThree(fit, tables, strains_q32);
}

}  // namespace strainfinger::firmware
