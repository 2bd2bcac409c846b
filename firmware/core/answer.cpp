#include "firmware/core/answer.hpp"

#include <algorithm>
#include <cstdlib>

namespace strainfinger::firmware {
namespace {

/// Fits closer than this ran into the same maximum.
constexpr PitchQ20 kSameAnswer = kOnePitch / 12;

/// Fits farther from their middle gauge than this belong to another window.
constexpr PitchQ20 kFarFromMiddle = kOnePitch * 53 / 100;

/// A contact leaves about this part of its energy outside its window, as a power of two: up to 2 % with 16
/// gauges and fewer, a few percent with more, which are not in doubt.
constexpr int kTailShift = 6;

bool withinCone(const TableConstants& constants, const Amplitudes& amplitudes) {
  if (amplitudes.normal <= 0) return false;
  const std::int64_t limit = std::int64_t{amplitudes.normal} * constants.friction_cone_q8;
  return std::abs(amplitudes.tangential) <= limit >> 8;
}

PitchQ20 distance(const Answer& a, const Answer& b, int gauges) {
  const PitchQ20 ahead = roundTheRing(a.fit.position() - b.fit.position(), gauges);
  return std::min(ahead, gauges * kOnePitch - ahead);
}

/// Beyond the last row: what the fit looks for belongs to another window.
bool walkedOut(const WindowFit& fit) { return fit.offset() >= kFitRows * kRowSpacing; }

/// The window in which the contact is nearer to the middle.
void changeWindow(const Problem& problem, WindowFit& fit) {
  const int centre = wrapped(fit.centre + fit.side, problem.gauges());
  const int row = nearestRow(kOnePitch - fit.offset());
  start(problem, windowSignal(problem.strains, centre, problem.up), centre, -fit.side * row, fit);
}

}  // namespace

void start(const Problem& problem, const Signal& signal, int centre, int row, WindowFit& fit) {
  fit.signal = row >= 0 ? signal : mirrored(signal, problem.mirrorSign());
  fit.centre = centre;
  fit.side = row >= 0 ? 1 : -1;
  fit.row = std::abs(row);
  takeStep(problem.tables.rows, fit);
}

void finishNearMiddle(const Problem& problem, Answer& answer) {
  refine(problem.tables.rows, problem.mirrorSign(), answer.fit);
  if (answer.fit.offset() > kFarFromMiddle) changeWindow(problem, answer.fit);
  finish(problem, answer);
}

void finish(const Problem& problem, Answer& answer) {
  WindowFit& fit = answer.fit;
  const bool settled = refine(problem.tables.rows, problem.mirrorSign(), fit);
  answer.amplitudes = amplitudesOf(problem.tables.rows[static_cast<std::size_t>(fit.row)], fit.step);
  answer.energy = fit.step.energy();
  answer.windowEnergy = energyOf(fit.signal);
  const bool pressed = withinCone(problem.tables.constants, answer.amplitudes);
  const std::int32_t outside = std::min(problem.ringEnergy - answer.windowEnergy, answer.windowEnergy >> kTailShift);
  answer.standing = {.energy = answer.energy + outside,
                     .found = true,
                     .admissible = settled && pressed,
                     .isRival = pressed && (settled || !walkedOut(fit))};
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
