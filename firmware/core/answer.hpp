#pragma once
// Refined fits, and which of them to believe.

#include "firmware/core/problem.hpp"
#include "firmware/core/scan.hpp"
#include "firmware/core/window_fit.hpp"

namespace strainfinger::firmware {

/// A refined fit and how it stands against others.
struct Answer {
  WindowFit fit;
  Amplitudes amplitudes{};
  std::int32_t energy = -1;    ///< that all seven gauges say it explains
  std::int32_t standing = -1;  ///< the energy, and what a contact there may have left outside the window
  bool settled = false;
  bool withinCone = false;  ///< presses, and no harder sideways than friction allows
  bool found = false;

  bool betterThan(const Answer& other) const {
    if (!other.found) return true;
    if (admissible() != other.admissible()) return admissible();
    return standing > other.standing;
  }
  bool admissible() const { return settled && withinCone; }
  /// Beyond the last row: what the fit looks for belongs to another window.
  bool walkedOut() const { return !settled && fit.offset >= kFitRows * kRowSpacing; }
  /// An answer to reckon with, if only as the next best.
  bool isRival() const { return found && withinCone && !walkedOut(); }
};

/// Refines the fit that starts at one offset of a scan. In three-point mode the three readings give the
/// answer, and all seven its standing.
Answer solve(const Problem& problem, const Scan& scan, int start);

/// Positions go round the ring; `position` is at most one turn off.
PitchQ20 roundTheRing(PitchQ20 position, int gauges);

/// The two best answers that are not the same one.
struct Contest {
  Answer best;
  Answer second;

  void enter(const Answer& answer, int gauges);
};

}  // namespace strainfinger::firmware
