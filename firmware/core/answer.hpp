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

/// What a refined fit comes to. Apart from the fit, so that it may stay in registers.
struct Judgement {
  std::int32_t normal;  ///< amplitudes, the tangential one + towards the fit's side
  std::int32_t tangential;
  std::int32_t energy;        ///< that the seven gauges say it explains ..
  std::int32_t windowEnergy;  ///< .. of so much
  bool settled;               ///< the steps came to an end within the table
  bool pressed;               ///< presses, and no harder sideways than friction allows

  bool admissible() const { return settled && pressed; }
  std::int32_t unexplained() const { return windowEnergy - energy; }
};

[[gnu::always_inline]] inline Placement placementOf(const WindowFit& fit, const Judgement& judgement,
                                                    int gauges) {
  return {roundTheRing(fit.position(), gauges), judgement.normal, fit.side * judgement.tangential};
}

/// Fits farther from their middle gauge than this belong to another window.
inline constexpr PitchQ20 kFarFromMiddle = kOnePitch * 53 / 100;

inline bool withinCone(const TableConstants& constants, std::int32_t normal, std::int32_t tangential) {
  if (normal <= 0) return false;
  const std::int32_t limit = mulHigh(normal, constants.friction_cone_q8 << 15);
  return absolute(tangential) >> 9 <= limit;
}

/// What a fit's last step says.
inline Judgement judged(const Problem& problem, const WindowFit& fit, bool settled) {
  const auto [normal, tangential] =
      amplitudesOf(*unknown(unknown(problem.tables.rows.data()) + fit.row), fit.step);
  return {normal,
          tangential,
          fit.step.energy(),
          energyOf(fit.signal),
          settled,
          withinCone(problem.tables.constants, normal, tangential)};
}

/// Which window a fit ends in.
enum class InWindow : std::uint8_t { kOwn, kNearest };

/// Refines a fit from its row. False: it did not settle.
bool solve(const Problem& problem, InWindow window, WindowFit& fit);

/// Positions of fits that ran, or are about to run, into the same maximum.
bool isNear(const Problem& problem, PitchQ20 one, PitchQ20 other);

/// Energy that a contact may have left outside a window of so much.
std::int32_t leftOutside(const Problem& problem, std::int32_t windowEnergy);

/// What decides between two answers.
struct Standing {
  std::int32_t energy;  ///< explained, and what a contact there may have left outside the window
  /// What may not be, beyond friction's cone or the table, counts for 28 variances less: noise may have moved
  /// it there, but is covered (coveredMargin()) only within two standard deviations.
  std::int32_t asRunnerUp;
  bool found;
  bool admissible;

  bool betterThan(const Standing& other) const {
    if (!other.found) return true;
    if (admissible != other.admissible) return admissible;
    return energy > other.energy;
  }
};
Standing standingOf(const Problem& problem, const WindowFit& fit, const Judgement& judgement);

}  // namespace strainfinger::firmware
