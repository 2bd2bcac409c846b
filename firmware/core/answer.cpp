#include "firmware/core/answer.hpp"

#include <algorithm>

namespace strainfinger::firmware {
namespace {

/// Fits closer than this ran into the same maximum.
constexpr PitchQ20 kSameAnswer = kOnePitch / 12;

/// A contact leaves about this part of its energy outside its window, as a power of two: up to 2 % with 16
/// gauges and fewer, a few percent with more, which are not in doubt.
constexpr int kTailShift = 6;

/// Beyond the last row: what the fit looks for belongs to another window.
bool walkedOut(const WindowFit& fit) { return fit.offset() >= kFitRows * kRowSpacing; }

/// Into the window in which the contact is nearer to the middle.
void changeWindow(const Problem& problem, WindowFit& fit) {
  const int centre = wrapped(fit.centre + fit.side, problem.gauges());
  const int row = nearestRow(kOnePitch - fit.offset());
  fit.start(signalAround(problem, centre), centre, -fit.side * row, problem.mirrorSign());
}

}  // namespace

void solve(const Problem& problem, InWindow window, Answer& answer) {
  const FitTable& rows = problem.tables.rows;
  WindowFit& fit = answer.fit;
  for (bool mayMove = window == InWindow::kNearest;; mayMove = false) {
    answer.settled = refine(rows, problem.mirrorSign(), fit);
    if (!mayMove || fit.offset() <= kFarFromMiddle) break;
    changeWindow(problem, fit);
  }
  judge(problem, answer);
}

bool isNear(const Problem& problem, PitchQ20 one, PitchQ20 other) {
  const PitchQ20 ring = problem.gauges() * kOnePitch;
  const PitchQ20 apart = absolute(one - other);
  return std::min(apart, absolute(ring - apart)) < kSameAnswer;
}

Standing standingOf(const Problem& problem, const Answer& answer) {
  const std::int32_t outside =
      std::min(problem.ringEnergy - answer.windowEnergy, answer.windowEnergy >> kTailShift);
  return {.energy = answer.energy + outside,
          .found = true,
          .admissible = answer.admissible(),
          .isRival = answer.pressed && (answer.settled || !walkedOut(answer.fit))};
}

void Contest::enter(const Problem& problem, const Answer& answer) {
  const Standing standing = standingOf(problem, answer);
  const bool wins = standing.betterThan(first);
  const bool sameAgain = first.found && isNear(problem, answer.fit.position(), best.fit.position());
  if (wins) {
    if (first.found && !sameAgain) setSecond(first, best, problem.gauges());
    best = answer;
    first = standing;
  } else if (!sameAgain && standing.betterThan(second)) {
    setSecond(standing, answer, problem.gauges());
  }
}

}  // namespace strainfinger::firmware
