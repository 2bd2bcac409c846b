#include "firmware/core/answer.hpp"

#include <algorithm>
#include <cstdlib>

namespace strainfinger::firmware {
namespace {

/// Fits closer than this ran into the same maximum.
constexpr PitchQ20 kSameAnswer = kOnePitch / 12;

/// A contact leaves about this part of its energy outside its window, as a power of two: up to 2 % with 16
/// gauges and fewer, a few percent with more, which are not in doubt.
constexpr int kTailShift = 6;

bool withinCone(const TableConstants& constants, const Amplitudes& amplitudes) {
  if (amplitudes.normal <= 0) return false;
  const std::int64_t limit = std::int64_t{amplitudes.normal} * constants.friction_cone_q8;
  return std::int64_t{std::abs(amplitudes.tangential)} * 256 <= limit;
}

PitchQ20 distance(const Answer& a, const Answer& b, int gauges) {
  const PitchQ20 ahead = roundTheRing(a.fit.position() - b.fit.position(), gauges);
  return std::min(ahead, gauges * kOnePitch - ahead);
}

/// Beyond the last row: what the fit looks for belongs to another window.
bool walkedOut(const WindowFit& fit) { return fit.offset >= kFitRows * kRowSpacing; }

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
  const bool settled = refine(tables, problem.mirrorSign(), fit);
  answer.amplitudes = amplitudesOf(tables, fit);
  answer.energy = fit.energy;
  if (problem.mode == FitMode::kThreePoint)
    answer.energy = explainedEnergy(problem.tables.refined[static_cast<std::size_t>(fit.row)], fit.signal,
                                    fit.offset - fit.row * kRowSpacing);
  const std::int32_t window = energyOf(fit.signal);
  const bool pressed = withinCone(problem.tables.constants, answer.amplitudes);
  answer.standing = {.energy = answer.energy + std::min(problem.ringEnergy - window, window >> kTailShift),
                     .found = true,
                     .admissible = settled && pressed,
                     .isRival = pressed && (settled || !walkedOut(fit))};
  return answer;
}

Placement Answer::placement(int gauges) const {
  return {roundTheRing(fit.position(), gauges), amplitudes.normal, fit.side * amplitudes.tangential};
}

PitchQ20 roundTheRing(PitchQ20 position, int gauges) {
  const PitchQ20 ring = gauges * kOnePitch;
  if (position < 0) return position + ring;
  return position >= ring ? position - ring : position;
}

void Contest::enter(const Answer& answer, int gauges) {
  const bool wins = answer.standing.betterThan(best.standing);
  if (best.standing.found && distance(answer, best, gauges) < kSameAnswer) {
    if (wins) best = answer;
  } else if (wins) {
    if (best.standing.found) setSecond(best, gauges);
    best = answer;
  } else if (answer.standing.betterThan(second)) {
    setSecond(answer, gauges);
  }
}

}  // namespace strainfinger::firmware
