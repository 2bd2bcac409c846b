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
  const std::int32_t limit = mulHigh(amplitudes.normal, constants.friction_cone_q8 << 15);
  return std::abs(amplitudes.tangential) >> 9 <= limit;
}

/// Beyond the last row: what the fit looks for belongs to another window.
bool walkedOut(const WindowFit& fit) { return fit.offset() >= kFitRows * kRowSpacing; }

/// The window in which the contact is nearer to the middle.
WindowFit inNextWindow(const Problem& problem, const WindowFit& fit) {
  const int centre = wrapped(fit.centre + fit.side, problem.gauges());
  const int row = nearestRow(kOnePitch - fit.offset());
  return fitAt(problem, windowSignal(problem.strains, centre, problem.up), centre, -fit.side * row);
}

/// What the table says of a fit that was refined.
void judge(const Problem& problem, bool settled, Answer& answer) {
  const WindowFit& fit = answer.fit;
  answer.amplitudes = amplitudesOf(problem.tables.rows[static_cast<std::size_t>(fit.row)], fit.step);
  answer.energy = fit.step.energy();
  answer.windowEnergy = energyOf(fit.signal);
  answer.settled = settled;
  answer.pressed = withinCone(problem.tables.constants, answer.amplitudes);
}

bool refined(const Problem& problem, WindowFit& fit) {
  return refine(problem.tables.rows, problem.mirrorSign(), fit);
}

}  // namespace

WindowFit fitAt(const Problem& problem, const Signal& signal, int centre, int row) {
  if (row >= 0) return {signal, centre, 1, row, {}};
  return {mirrored(signal, problem.mirrorSign()), centre, -1, -row, {}};
}

void solve(const Problem& problem, Answer& answer) { judge(problem, refined(problem, answer.fit), answer); }

void solveNearMiddle(const Problem& problem, Answer& answer) {
  bool settled = refined(problem, answer.fit);
  if (answer.fit.offset() > kFarFromMiddle) {
    answer.fit = inNextWindow(problem, answer.fit);
    settled = refined(problem, answer.fit);
  }
  judge(problem, settled, answer);
}

bool isNear(const Problem& problem, const WindowFit& one, const WindowFit& other) {
  const PitchQ20 ring = problem.gauges() * kOnePitch;
  const PitchQ20 apart = std::abs(one.position() - other.position());
  return std::min(apart, std::abs(ring - apart)) < kSameAnswer;
}

Standing standingOf(const Problem& problem, const Answer& answer) {
  const std::int32_t outside =
      std::min(problem.ringEnergy - answer.windowEnergy, answer.windowEnergy >> kTailShift);
  return {.energy = answer.energy + outside,
          .found = true,
          .admissible = answer.admissible(),
          .isRival = answer.pressed && (answer.settled || !walkedOut(answer.fit))};
}

Placement Answer::placement(int gauges) const {
  return {roundTheRing(fit.position(), gauges), amplitudes.normal, fit.side * amplitudes.tangential};
}

PitchQ20 roundTheRing(PitchQ20 position, int gauges) {
  const PitchQ20 ring = gauges * kOnePitch;
  if (position < 0) return position + ring;
  return position >= ring ? position - ring : position;
}

void Contest::enter(const Problem& problem, const Answer& answer) {
  const int gauges = problem.gauges();
  const Standing standing = standingOf(problem, answer);
  const bool wins = standing.betterThan(first);
  const bool sameAgain = first.found && isNear(problem, answer.fit, best.fit);
  if (wins) {
    if (first.found && !sameAgain) setSecond(first, best, gauges);
    best = answer;
    first = standing;
  } else if (!sameAgain && standing.betterThan(second)) {
    setSecond(standing, answer, gauges);
  }
}

}  // namespace strainfinger::firmware
