#include "firmware/core/triple_fit.hpp"

#include <algorithm>

#include "firmware/core/locate.hpp"
#include "firmware/core/near_fit.hpp"
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
  if (absolute(system.volume) < kLeastVolume) return false;
  fit.step = tripleStep(row, system, twiceRead(fit.signal, kTripleList[triple]), u);
  return true;
}

/// The window fit that a fit of seven readings came from.
WindowFit windowFitOf(const TableImage& tables, const std::int32_t* strains_q32, const Fit& fit) {
  WindowFit window;
  const TableConstants& constants = tables.constants;
  const PitchQ20 offset = fit.offset(constants.gauge_count);
  const int row = static_cast<int>(fit.row - tables.rows.data());
  const Problem problem{tables, {strains_q32, constants.gauge_count}, fit.up, fit.windowEnergy, 1};
  const Signal signal = signalAround(problem, fit.centre);
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
  if (locateByNearest(fit, tables, strains_q32, energy)) return;
  locateBySeven(fit, tables, strains_q32, energy);
  if (fit.settled) leaveToThree(fit, tables, strains_q32);
}

}  // namespace strainfinger::firmware
