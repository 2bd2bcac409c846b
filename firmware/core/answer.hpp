#pragma once
// Refined fits, and which of them to believe.

#include "firmware/core/problem.hpp"
#include "firmware/core/scan.hpp"
#include "firmware/core/window_fit.hpp"

namespace strainfinger::firmware {

/// A line contact at `position` [pitches * 2^20 from gauge 0, within the ring] with the amplitudes of its
/// loads (tangential + towards +theta).
struct Placement {
  PitchQ20 position;
  std::int32_t normal;
  std::int32_t tangential;
};

/// What decides between two answers.
struct Standing {
  std::int32_t energy;  ///< explained, and what a contact there may have left outside the window
  bool found;
  bool admissible;  ///< settled, presses, and no harder sideways than friction allows
  bool isRival;     ///< to be reckoned with, if only as the next best

  bool betterThan(const Standing& other) const {
    if (!other.found) return true;
    if (admissible != other.admissible) return admissible;
    return energy > other.energy;
  }
};

/// A refined fit and how it stands against others.
struct Answer {
  WindowFit fit;
  Amplitudes amplitudes;
  std::int32_t energy;  ///< that the seven gauges say it explains ..
  std::int32_t windowEnergy;  ///< .. of so much
  Standing standing;

  Placement placement(int gauges) const;
};

/// A fit at a row of a window (negative: on its - side), its first step taken.
void start(const Problem& problem, const Signal& signal, int centre, int row, WindowFit& fit);

/// Refines the answer's fit, whose first step is taken, and judges it; finishNearMiddle() in the window where
/// it is nearest to the middle.
void finish(const Problem& problem, Answer& answer);
void finishNearMiddle(const Problem& problem, Answer& answer);

/// Positions go round the ring; `position` is at most one turn off.
PitchQ20 roundTheRing(PitchQ20 position, int gauges);

/// The best answer, and the next best that is not the same one: of that only what is reported, for the
/// stack's sake.
struct Contest {
  Answer best;
  Standing second;
  Placement secondPlacement;

  Contest() { best.standing.found = second.found = false; }

  void enter(const Answer& answer, int gauges);

 private:
  void setSecond(const Answer& answer, int gauges) {
    second = answer.standing;
    secondPlacement = answer.placement(gauges);
  }
};

}  // namespace strainfinger::firmware
