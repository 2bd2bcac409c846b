#include "firmware/core/answer.hpp"

#include <algorithm>

namespace strainfinger::firmware {
namespace {

/// Fits closer than this ran into the same maximum.
constexpr PitchQ20 kSameAnswer = kOnePitch / 12;

/// Beyond the last row: what the fit looks for belongs to another window.
bool walkedOut(const WindowFit& fit) { return fit.offset() >= kFitRows * kRowSpacing; }

/// Into the window in which the contact is nearer to the middle.
void changeWindow(const Problem& problem, WindowFit& fit) {
  const int centre = wrapped(fit.centre + fit.side, problem.gauges());
  const int row = nearestRow(kOnePitch - fit.offset());
  fit.start(signalAround(problem, centre), centre, -fit.side * row, problem.mirrorSign());
}

}  // namespace

std::int32_t leftOutside(const Problem& problem, std::int32_t windowEnergy) {
  return std::min(problem.ringEnergy - windowEnergy, mostOutside(windowEnergy, problem.tail_q16()));
}

bool solve(const Problem& problem, InWindow window, WindowFit& fit) {
  for (bool mayMove = window == InWindow::kNearest;; mayMove = false) {
    const bool settled = refine(problem.tables.rows, problem.mirrorSign(), fit);
    if (!mayMove || fit.offset() <= kFarFromMiddle) return settled;
    changeWindow(problem, fit);
  }
}

bool isNear(const Problem& problem, PitchQ20 one, PitchQ20 other) {
  const PitchQ20 ring = problem.gauges() * kOnePitch;
  const PitchQ20 apart = absolute(one - other);
  return std::min(apart, absolute(ring - apart)) < kSameAnswer;
}

Standing standingOf(const Problem& problem, const WindowFit& fit, const Judgement& judgement) {
  const std::int32_t energy = judgement.energy + leftOutside(problem, judgement.windowEnergy);
  static_assert(kNoiseUnit == 32);
  const bool mayBe = judgement.pressed && (judgement.settled || !walkedOut(fit));
  return {.energy = energy,
          .asRunnerUp = mayBe ? energy : energy - (problem.noise - problem.noise / 8),
          .found = true,
          .admissible = judgement.admissible()};
}

}  // namespace strainfinger::firmware
