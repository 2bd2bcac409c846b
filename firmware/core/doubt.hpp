#pragma once
// When the first answer may not be the best, and what is done about it: rare.

#include "firmware/core/locate.hpp"
#include "firmware/core/scan.hpp"

namespace strainfinger::firmware {

/// Has the ring less energy than 2^exponent variances of a reading? From 5 on.
inline bool isBelow(const Problem& problem, int exponent) {
  static_assert(kNoiseUnit == 1 << 5);
  return problem.ringEnergy >> (exponent - 5) < problem.noise;
}

/// So weak a ring can look right in any window.
inline bool isWeak(const Problem& problem) { return isBelow(problem, 10); }
/// .. two gauges away.
inline bool mayBeAlias(const Problem& problem) { return isBelow(problem, 13); }

/// Nearer to a gauge than this the readings may hardly change as a contact and its load move together: there
/// may be two answers, one on either side.
inline constexpr PitchQ20 kBesideGauge = kOnePitch / 4;
/// Noise may hide what tells them apart up to 260,000 variances, or twice as many where they are within 1/16
/// pitch, seen with 16 gauges (of 18, which have the most such contacts, 8,400,000:
/// LocateAccuracy.NoPlaceAcrossAGaugeIsTakenForCertain).
inline bool mayBeHidden(const Problem& problem, PitchQ20 offset) {
  const std::int32_t energy = problem.ringEnergy >> (hasOuterPair(problem.gauges()) ? 19 : 14);
  return energy < problem.noise && (absolute(offset) < kOnePitch / 16 || 2 * energy < problem.noise);
}

/// Of contacts a quarter of a pitch or more from their window's middle gauge no other offset of the window
/// explains the readings within noise.
inline bool isFirm(const Problem& problem) {
  return !isBelow(problem, problem.tables.constants.firm_exponent);
}

/// Another window may hold a better answer: the contact's own leaves but noise and 1/4096, and a contact less
/// than 1/32 outside its window.
inline bool doubtful(const Problem& problem, bool admissible, std::int32_t unexplained, std::int32_t window) {
  return !admissible || mayBeAlias(problem) || unexplained > problem.noise + (window >> 12) ||
         problem.ringEnergy - window > problem.noise + (window >> 5);
}

/// Answers whose energies differ by fewer variances are not told apart: four standard errors.
inline constexpr int kToldApart = 16;

/// Where two answers differ by less, the reported errors cover both. Of two places d standard errors apart
/// the wrong one explains 32 variances more as noise is (32 + d^2) / (2 d) standard errors, at least
/// sqrt(32): once in 10^8.
inline std::int32_t coveredMargin(const Problem& problem, std::int32_t window) {
  static_assert(kNoiseUnit == 32);
  return problem.noise + (window >> 14);
}

/// Where a single step from a row of a window leads.
struct Lead {
  PitchQ20 offset;      ///< from the window's middle gauge, negative on its - side
  std::int32_t energy;  ///< explained there

  int row() const { return offset < 0 ? -nearestRow(-offset) : nearestRow(offset); }
};

/// What is reported of an answer, but for the alternative.
[[gnu::always_inline]] inline void report(const Problem& problem, const WindowFit& from,
                                          const Judgement& judgement, PitchQ20 position, Fit& fit) {
  fit.best.position = position;
  fit.best.normal = judgement.normal;
  fit.best.tangential = from.side * judgement.tangential;
  fit.row = unknown(problem.tables.rows.data()) + from.row;
  fit.projection = from.step.projection;
  fit.information = from.step.information;
  fit.unexplained = judgement.unexplained();
  fit.windowEnergy = judgement.windowEnergy;
  fit.up = static_cast<std::int8_t>(problem.up);
  fit.centre = static_cast<std::uint8_t>(from.centre);
  fit.readings = FitMode::kRefined;
  fit.reduced = false;
  fit.settled =
      judgement.settled & judgement.pressed & (judgement.energy >> 1 > problem.noise);  // 64 variances
}

/// Goes on from a first answer that may not be the best. If it is ambiguous so far, `alternative.position` is
/// where to look as well: an offset in its window.
void searchOn(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32, std::int32_t ringEnergy);

/// The fit that is reached from a position of the same ring, instead of the one that was found; no other.
void locateAt(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32, PitchQ20 position);

/// Looks at every window: where the model's strongest response has no single peak over the contact, or noise
/// may hide it.
void searchEverywhere(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32,
                      std::int32_t ringEnergy);

}  // namespace strainfinger::firmware
