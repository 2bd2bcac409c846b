#include "firmware/core/answer.hpp"

#include <algorithm>
#include <cstdlib>

namespace strainfinger::firmware {
namespace {

/// Fits closer than this ran into the same maximum.
constexpr PitchQ20 kSameAnswer = kOnePitch / 12;

bool withinCone(const TableConstants& constants, const Amplitudes& amplitudes) {
  if (amplitudes.normal <= 0) return false;
  const std::int64_t limit = std::int64_t{amplitudes.normal} * constants.friction_cone_q8;
  return std::int64_t{std::abs(amplitudes.tangential)} * 256 <= limit;
}

PitchQ20 distance(const Answer& a, const Answer& b, int gauges) {
  const PitchQ20 ahead = roundTheRing(a.fit.position() - b.fit.position(), gauges);
  return std::min(ahead, gauges * kOnePitch - ahead);
}

}  // namespace

Answer solve(const Problem& problem, const Scan& scan, int start) {
  Answer answer;
  WindowFit& fit = answer.fit;
  fit.centre = scan.centre;
  fit.side = scan.side(start);
  fit.signal = fit.side > 0 ? scan.signal : mirrored(scan.signal, problem.mirrorSign());
  fit.offset = scan.row(start) * kRowSpacing;
  fit.sense = scan.pullsBack(start) ? kAgainstOffset : kWithOffset;
  const FitTables tables = problem.fitTables();
  answer.settled = refine(tables, problem.mirrorSign(), fit);
  answer.amplitudes = amplitudesOf(tables, fit);
  answer.withinCone = withinCone(problem.tables.constants, answer.amplitudes);
  answer.found = true;
  answer.energy = fit.energy;
  if (problem.mode == FitMode::kThreePoint)
    answer.energy = fitStep(problem.tables.refined[static_cast<std::size_t>(fit.row)], fit.signal).energy;
  return answer;
}

PitchQ20 roundTheRing(PitchQ20 position, int gauges) {
  const PitchQ20 ring = gauges * kOnePitch;
  if (position < 0) return position + ring;
  return position >= ring ? position - ring : position;
}

void Contest::enter(const Answer& answer, int gauges) {
  if (best.found && distance(answer, best, gauges) < kSameAnswer) {
    if (answer.betterThan(best)) best = answer;
    return;
  }
  if (answer.betterThan(best)) {
    second = best;
    best = answer;
  } else if (answer.betterThan(second)) {
    second = answer;
  }
}

}  // namespace strainfinger::firmware
