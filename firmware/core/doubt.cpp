#include "firmware/core/doubt.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "firmware/core/tangent.hpp"
#include "firmware/core/whole_scan.hpp"

namespace strainfinger::firmware {
namespace {

/// So weak a ring can look right three gauges away.
bool mayBeFarAlias(const Problem& problem) { return isBelow(problem, 14); }

/// How much less a peak of a scan may explain than the best and still win once it is refined.
std::int32_t rivalLimit(const Problem& problem, std::int32_t best) {
  constexpr int kStarterShift = 4;
  return best - (best >> kStarterShift) - problem.noise;
}

/// Two answers whose energies differ by less explain the readings equally well, within four standard errors
/// of noise and rounding (1/2^14).
std::int32_t marginOf(const Problem& problem, std::int32_t window) {
  static_assert(kNoiseUnit == 2 * kToldApart);
  const std::int32_t apart = problem.noise / 2;
  return (isWeak(problem) ? 2 * apart : apart) + (window >> 14);
}

/// The best few of any number of starts, the best first.
class Shortlist {
 public:
  Shortlist() { starts_.fill({-1, 0, 0}); }
  void add(const Start& start) {
    if (start.energy <= starts_.back().energy) return;
    auto at = starts_.end() - 1;
    for (; at != starts_.begin() && start.energy > (at - 1)->energy; --at) *at = *(at - 1);
    *at = start;
  }
  void add(const Scan& scan, int centre) {
    add(startAt(centre, scan.middle));
    add(startAt(centre, scan.minus));
    add(startAt(centre, scan.plus));
  }
  const auto& starts() const { return starts_; }

 private:
  std::array<Start, 6> starts_;
};

/// The best answer, in what is reported, and the next best that is not the same one.
struct Contest {
  Fit& fit;
  bool keeps = false;  ///< the first answer, should another way lead to it
  Standing first{}, second{};

  void enter(const Problem& problem, const WindowFit& from, const Judgement& judgement);
};

void Contest::enter(const Problem& problem, const WindowFit& from, const Judgement& judgement) {
  const Standing standing = standingOf(problem, from, judgement);
  const Placement place = placementOf(from, judgement, problem.gauges());
  const bool sameAgain = first.found && isNear(problem, place.position, fit.best.position);
  if (sameAgain && keeps) return;
  if (standing.betterThan(first)) {
    const bool staysSecond = second.found && second.asRunnerUp > first.asRunnerUp &&
                             !isNear(problem, place.position, fit.alternative.position);
    if (first.found && !sameAgain && !staysSecond) {
      second = first;
      fit.alternative = fit.best;
    }
    first = standing;
    report(problem, from, judgement, place.position, fit);
  } else if (!sameAgain && (!second.found || standing.asRunnerUp > second.asRunnerUp)) {
    second = standing;
    fit.alternative = place;
  }
}

/// Refines a fit from a row of a window and enters it, in a frame of its own.
[[gnu::noinline]] void enterFit(const Problem& problem, InWindow window, int centre, int row,
                                Contest& contest) {
  WindowFit fit;
  fit.start(signalAround(problem, centre), centre, row, problem.mirrorSign());
  const bool settled = solve(problem, window, fit);
  contest.enter(problem, fit, judged(problem, fit, settled));
}

/// Refines every start of the list that may win.
[[gnu::noinline, gnu::cold]] void enterBest(const Problem& problem, const Shortlist& list, Contest& contest) {
  const std::int32_t limit = rivalLimit(problem, list.starts()[0].energy);
  for (const Start& from : list.starts()) {
    if (from.energy <= limit) return;
    enterFit(problem, InWindow::kOwn, from.centre, from.row, contest);
  }
}

[[gnu::noinline]] Shortlist startsAnywhere(const Problem& problem) {
  Shortlist list;
  const FitTable& rows = problem.tables.rows;
  for (int gauge = 0; gauge < problem.gauges(); ++gauge)
    list.add(scanned(rows, signalAround(problem, gauge), problem.tables.constants.scan_step), gauge);
  return list;
}

/// Contacts midway between two gauges may have their anchor (the deepest reading, or the sharpest bend) two
/// gauges away; where noise may tip the balance, the answer may lie three from the contact: enters what is
/// there, on either side.
inline void enterBeside(const Problem& problem, Contest& contest) {
  const int anchor = contest.fit.anchor, centre = contest.fit.centre;
  const std::array<int, 4> centres{anchor - 2, anchor + 2, centre - 3, centre + 3};
  std::array<Start, 4> starts;
  const std::size_t count = mayBeFarAlias(problem) ? 4 : 2;
  std::int32_t best = 0;
  for (std::size_t i = 0; i < count; ++i) {
    starts[i] = midwayStart(problem, wrapped(centres[i], problem.gauges()));
    best = std::max(best, starts[i].energy);
  }
  for (std::size_t i = 0; i < count; ++i)
    if (starts[i].energy > rivalLimit(problem, best))
      enterFit(problem, InWindow::kOwn, starts[i].centre, starts[i].row, contest);
}

/// Whether noise may hide another place beside the gauge of an answer that is so far from it.
inline bool mayLieAcross(const Problem& problem, PitchQ20 offset) {
  return absolute(offset) < kBesideGauge && mayBeHidden(problem, offset);
}

/// Another place beside the gauge, whatever load it takes, and how much less of the readings it explains.
struct Across {
  Placement place;
  std::int32_t deficit;
};
[[gnu::noinline]] Across lookAcross(const Problem& problem, const Fit& fit, PitchQ20 offset) {
  WindowFit there;
  there.start(signalAround(problem, fit.centre), fit.centre, Lead{offset, 0}.row(), problem.mirrorSign());
  takeStep(problem.tables.rows, there);
  there.step.length = there.step.slope = 0;
  const Judgement judgement = judged(problem, there, true);
  return {placementOf(there, judgement, problem.gauges()),
          std::max<std::int32_t>(fit.windowEnergy - fit.unexplained - judgement.energy, 0)};
}

/// Where no second answer lies across the gauge, a shallow valley may lead there, or halfway, all the same:
/// the answer's own information then says too much.
[[gnu::noinline, gnu::cold]] void coverValley(const Problem& problem, Fit& fit, PitchQ20 offset) {
  if (!fit.settled || !mayLieAcross(problem, fit.offset(problem.gauges()))) return;
  Across across = lookAcross(problem, fit, offset);
  if (offset != 0 && across.deficit >= problem.noise) across = lookAcross(problem, fit, 0);
  if (across.deficit >= problem.noise) return;
  fit.deficit = across.deficit;
  fit.alternative = across.place;
}

/// Says in the report whether the runner-up explains the readings as well, within noise.
void conclude(const Problem& problem, const Contest& contest) {
  Fit& fit = contest.fit;
  if (!contest.second.found) fit.alternative = fit.best;
  const std::int32_t deficit = contest.first.energy - contest.second.asRunnerUp;
  const bool covered = contest.second.found && deficit < coveredMargin(problem, fit.windowEnergy);
  fit.deficit = covered ? std::max<std::int32_t>(deficit, 0) : kNoRival;
  fit.ambiguous = covered && deficit < marginOf(problem, fit.windowEnergy);
}

Problem problemAgain(const Fit& fit, const TableImage& tables, const std::int32_t* strains_q32,
                     std::int32_t ringEnergy) {
  const TableConstants& constants = tables.constants;
  return {tables, {strains_q32, constants.gauge_count}, fit.up, ringEnergy, noiseEnergy(constants, fit.up)};
}

}  // namespace

void searchOn(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32, std::int32_t ringEnergy) {
  const Problem problem = problemAgain(fit, tables, strains_q32, ringEnergy);
  Contest contest{fit};
  const int centre = fit.centre;
  const PitchQ20 offset = fit.offset(problem.gauges());
  const bool stays = fit.settled && absolute(offset) <= kFarFromMiddle;
  PitchQ20 rival = fit.alternative.position;
  bool contested = fit.ambiguous;
  if (stays && !contested) {
    rival = -offset;
    contest.keeps = contested =
        mayLieAcross(problem, offset) && lookAcross(problem, fit, rival).deficit < 2 * problem.noise;
    if (!contested && !doubtful(problem, true, fit.unexplained, fit.windowEnergy))
      return coverValley(problem, fit, 0);
  }
  const std::int32_t energy = fit.windowEnergy - fit.unexplained + leftOutside(problem, fit.windowEnergy);
  if (stays)
    contest.first = {.energy = energy, .asRunnerUp = energy, .found = true, .admissible = true};
  else
    enterFit(problem, InWindow::kNearest, centre, Lead{offset, 0}.row(), contest);
  if (contested) enterFit(problem, InWindow::kNearest, centre, Lead{rival, 0}.row(), contest);
  const bool twofold = std::exchange(contest.keeps, false);
  if (doubtful(problem, fit.settled, fit.unexplained, fit.windowEnergy)) enterBeside(problem, contest);
  conclude(problem, contest);
  // Only then: the dearest contacts have two peaks in the scan, and a rival that was refined.
  if (twofold && fit.deficit == kNoRival) coverValley(problem, fit, -fit.offset(problem.gauges()));
}

[[gnu::cold]] void locateAt(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32,
                            PitchQ20 position) {
  const Problem problem = problemAgain(fit, tables, strains_q32, 0);
  Contest contest{fit};
  const View view = viewOf(problem, position);
  enterFit(problem, InWindow::kNearest, view.centre, view.side * view.row, contest);
  conclude(problem, contest);
}

void searchEverywhere(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32,
                      std::int32_t ringEnergy) {
  const Problem problem = problemAgain(fit, tables, strains_q32, ringEnergy);
  Contest contest{fit};
  enterBest(problem, startsAnywhere(problem), contest);
  conclude(problem, contest);
  if (fit.deficit == kNoRival) coverValley(problem, fit, -fit.offset(problem.gauges()));
}

}  // namespace strainfinger::firmware
