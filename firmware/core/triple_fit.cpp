#include "firmware/core/triple_fit.hpp"

#include "firmware/core/locate.hpp"
#include "firmware/core/scan.hpp"

namespace strainfinger::firmware {
namespace {

/// Three readings that lead farther than this from where all seven do are no better than the seven.
constexpr PitchQ20 kFarthest = kOnePitch / 16;

/// A step from a row onto which the signal is projected.
bool takeTripleStep(const FitRow& row, WindowFit& fit) {
  const Projections u = fit.step.projection;
  const TripleChoice choice = tripleChoice(row, u);
  if (absolute(choice.system.volume) < 1 << 16) return false;
  fit.step = tripleStep(row, choice.system, twiceRead(fit.signal, choice.gauges), u);
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
  const GaugeTriple& gauges = kTripleList[row.triple[projection[1] < 0 ? kAgainstOffset : kWithOffset]];
  return {gauges, tripleSystem(row, gauges, projection)};
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
    if (absolute(fit.step.length) <= kRowSpacing << kRowStrideBits) return true;
  }
  return false;
}

void locateByThree(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32,
                   std::uint32_t energy) {
  locateBySeven(fit, tables, strains_q32, energy);
  if (fit.settled) leaveToThree(fit, tables, strains_q32);
}

}  // namespace strainfinger::firmware
