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

  bool operator==(const Placement&) const = default;
};

/// Positions go round the ring; `position` is at most one turn off.
inline PitchQ20 roundTheRing(PitchQ20 position, int gauges) {
  const PitchQ20 ring = gauges * kOnePitch;
  if (position < 0) return position + ring;
  return position >= ring ? position - ring : position;
}

/// A refined fit.
struct Answer {
  WindowFit fit;
  Amplitudes amplitudes;
  std::int32_t energy;        ///< that the seven gauges say it explains ..
  std::int32_t windowEnergy;  ///< .. of so much
  bool settled;               ///< the steps came to an end within the table
  bool pressed;               ///< presses, and no harder sideways than friction allows

  bool admissible() const { return settled && pressed; }
  Placement placement(int gauges) const {
    return {roundTheRing(fit.position(), gauges), amplitudes.normal, fit.side * amplitudes.tangential};
  }
};

/// Fits farther from their middle gauge than this belong to another window.
inline constexpr PitchQ20 kFarFromMiddle = kOnePitch * 53 / 100;

inline bool withinCone(const TableConstants& constants, const Amplitudes& amplitudes) {
  if (amplitudes.normal <= 0) return false;
  const std::int32_t limit = mulHigh(amplitudes.normal, constants.friction_cone_q8 << 15);
  return absolute(amplitudes.tangential) >> 9 <= limit;
}

/// What a fit's last step says.
inline void judge(const Problem& problem, Answer& answer) {
  const WindowFit& fit = answer.fit;
  answer.energy = fit.step.energy();
  answer.windowEnergy = energyOf(fit.signal);
  answer.amplitudes = amplitudesOf(*unknown(unknown(problem.tables.rows.data()) + fit.row), fit.step);
  answer.pressed = withinCone(problem.tables.constants, answer.amplitudes);
}

/// Which window a fit ends in.
enum class InWindow : std::uint8_t { kOwn, kNearest };

/// Refines the answer's fit from its row and judges it.
void solve(const Problem& problem, InWindow window, Answer& answer);

/// Positions of fits that ran, or are about to run, into the same maximum.
bool isNear(const Problem& problem, PitchQ20 one, PitchQ20 other);

/// What decides between two answers.
struct Standing {
  std::int32_t energy;  ///< explained, and what a contact there may have left outside the window
  bool found;
  bool admissible;
  bool isRival;  ///< to be reckoned with, if only as the next best

  bool betterThan(const Standing& other) const {
    if (!other.found) return true;
    if (admissible != other.admissible) return admissible;
    return energy > other.energy;
  }
};
Standing standingOf(const Problem& problem, const Answer& answer);

/// The best answer, and the next best that is not the same one: of that only what is reported, for the
/// stack's sake.
struct Contest {
  Answer& best;
  Standing first{}, second{};
  Placement secondPlacement;

  void enter(const Problem& problem, const Answer& answer);

 private:
  void setSecond(const Standing& standing, const Answer& answer, int gauges) {
    second = standing;
    secondPlacement = answer.placement(gauges);
  }
};

}  // namespace strainfinger::firmware
