#include "firmware/core/locate.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "firmware/core/answer.hpp"
#include "firmware/core/scan.hpp"
#include "firmware/core/triple_fit.hpp"

namespace strainfinger::firmware {
namespace {

/// A ring of less energy than 1024 variances can look right in any window, one of less than 4096 two or three
/// gauges away.
constexpr int kWeakShift = 5;
constexpr int kAliasShift = 7;

// Parts of the energy, as powers of two:
constexpr int kRivalShift = 5;      ///< within 1/32 (and kNoiseUnit variances) a window's second peak may win
constexpr int kStarterShift = 4;    ///< within 1/16 (and as many) a peak of another window may
constexpr int kRoundingShift = 12;  ///< 1/4096 is lost in rounding
constexpr int kAmbiguousShift = 14;  ///< rounding makes two fits differ by less than this
constexpr int kOneStepShift = 8;     ///< .. after a single step by less than this ..
constexpr int kTwoStepsShift = 12;   ///< .. and after a second by less than this
constexpr int kOutsideShift = 3;     ///< a contact leaves less than 1/8 of its energy outside its window

bool mayBeAlias(const Problem& problem) { return problem.ringEnergy >> kAliasShift < problem.noise; }
bool isWeak(const Problem& problem) { return problem.ringEnergy >> kWeakShift < problem.noise; }

/// How much less a peak of a scan may explain than the best and still win once it is refined.
std::int32_t rivalLimit(const Problem& problem, std::int32_t best, int shift) {
  return best - (best >> shift) - problem.noise;
}

/// Another window may hold a better answer.
inline bool doubtful(const Problem& problem, const Answer& answer) {
  const std::int32_t window = answer.windowEnergy;
  return !answer.admissible() || mayBeAlias(problem) ||
         window - answer.energy > problem.noise + (window >> kRoundingShift) ||
         problem.ringEnergy - window > problem.noise + (window >> kOutsideShift);
}

/// What explains two answers equally well, within noise and rounding.
std::int32_t marginOf(const Problem& problem, std::int32_t window) {
  const std::int32_t twelveVariances = problem.noise * 3 / 8;
  return (isWeak(problem) ? 2 * twelveVariances : twelveVariances) + (window >> kAmbiguousShift);
}

/// A place to start a fit from.
struct Start {
  std::int32_t energy;
  std::uint8_t centre;
  std::int8_t row;
};

/// The best few of any number of starts, the best first.
class Shortlist {
 public:
  Shortlist() { starts_.fill({-1, 0, 0}); }
  void add(const Peak& peak, int centre) {
    if (peak.energy <= starts_.back().energy) return;
    auto at = starts_.end() - 1;
    for (; at != starts_.begin() && peak.energy > (at - 1)->energy; --at) *at = *(at - 1);
    *at = {peak.energy, static_cast<std::uint8_t>(centre), static_cast<std::int8_t>(peak.row)};
  }
  void add(const Scan& scan, int centre) {
    add(scan.middle, centre);
    add(scan.minus, centre);
    add(scan.plus, centre);
  }
  const auto& starts() const { return starts_; }

 private:
  std::array<Start, 6> starts_;
};

/// Refines a fit from a row of a window and enters it, in a frame of its own.
[[gnu::noinline]] void enterFit(const Problem& problem, InWindow window, int centre, int row,
                                Contest& contest) {
  Answer answer;
  answer.fit.start(windowSignal(problem.strains, centre, problem.up), centre, row, problem.mirrorSign());
  solve(problem, window, answer);
  contest.enter(problem, answer);
}

/// Refines every start of the list that may win.
[[gnu::noinline]] void enterBest(const Problem& problem, const Shortlist& list, Contest& contest) {
  const std::int32_t limit = rivalLimit(problem, list.starts()[0].energy, kStarterShift);
  for (const Start& from : list.starts()) {
    if (from.energy <= limit) return;
    enterFit(problem, InWindow::kOwn, from.centre, from.row, contest);
  }
}

/// Where the model's strongest response has no single peak over the contact, or noise may hide it, every
/// window is looked at.
[[gnu::noinline]] Shortlist startsAnywhere(const Problem& problem) {
  Shortlist list;
  const FitTable& rows = problem.tables.rows;
  const bool finely = problem.tables.constants.scan_step == kMinScanStep;
  for (int gauge = 0; gauge < problem.gauges(); ++gauge) {
    const Signal signal = windowSignal(problem.strains, gauge, problem.up);
    if (finely) list.add(scanned<kMinScanStep / 2, kMinScanStep>(rows, signal), gauge);
    if (!finely) list.add(scanned<kMaxScanStep / 2, kMaxScanStep>(rows, signal), gauge);
  }
  return list;
}

/// Contacts midway between two gauges may bend the strains most one, two or three gauges away: looks there,
/// on either side of the windows two gauges off, and three where noise may tip the balance.
[[gnu::noinline]] Shortlist startsBeside(const Problem& problem, int anchor) {
  constexpr std::array kAway{-2, 2, -3, 3};
  Shortlist list;
  for (std::size_t i = 0; i < (mayBeAlias(problem) ? kAway.size() : 2); ++i) {
    const int centre = wrapped(anchor + kAway[i], problem.gauges());
    const Signal signal = windowSignal(problem.strains, centre, problem.up);
    list.add(bestTwo(scanned<20, kMaxScanStep>(problem.tables.rows, signal)).first, centre);
  }
  return list;
}

/// The runner-up explains the readings as well, within noise.
bool isAmbiguous(const Problem& problem, const Contest& contest) {
  return contest.second.isRival &&
         contest.second.energy > contest.first.energy - marginOf(problem, contest.best.windowEnergy);
}

inline Fit reportOf(const Problem& problem, const Contest& contest, FitMode readings) {
  const Answer& best = contest.best;
  const Placement placement = best.placement(problem.gauges());
  const bool alone = !contest.second.found;
  return {.best = placement,
          .alternative = alone ? placement : contest.secondPlacement,
          .row = &problem.tables.rows[static_cast<std::size_t>(best.fit.row)],
          .projection = best.fit.step.projection,
          .information = best.fit.step.information,
          .unexplained = best.windowEnergy - best.energy,
          .windowEnergy = best.windowEnergy,
          .up = static_cast<std::int8_t>(problem.up),
          .centre = static_cast<std::uint8_t>(best.fit.centre),
          .readings = readings,
          .ambiguous = !alone && isAmbiguous(problem, contest),
          .settled = best.admissible() && best.energy >> 1 > problem.noise};  // 64 variances
}

/// Leaves the answer to three readings if they lead where all seven do.
[[gnu::noinline]] FitMode settledByThree(const Problem& problem, Answer& answer) {
  if (!answer.admissible()) return FitMode::kRefined;
  WindowFit fit = answer.fit;
  if (!solveTriple(problem.tables.rows, problem.mirrorSign(), fit)) return FitMode::kRefined;
  answer.fit = fit;
  answer.amplitudes = amplitudesOf(problem.tables.rows[static_cast<std::size_t>(fit.row)], fit.step);
  return FitMode::kThreePoint;
}

/// Where a single step from a row of a window leads.
struct Lead {
  PitchQ20 offset;      ///< from the window's middle gauge, negative on its - side
  std::int32_t energy;  ///< explained there

  int row() const { return offset < 0 ? -nearestRow(-offset) : nearestRow(offset); }
};
[[gnu::noinline]] Lead leadFrom(const Problem& problem, const Signal& signal, int row) {
  WindowFit fit;
  fit.start(signal, 0, row, problem.mirrorSign());
  takeStep(problem.tables.rows, fit);
  return {fit.position(), fit.step.energy()};
}

/// Whether what a lead leads to may be another answer, as good: it explains what the answer does but for
/// noise and 1/2^shift.
bool mayBeAsGood(const Problem& problem, int anchor, const Lead& lead, const Answer& answer, int shift) {
  const std::int32_t most = answer.energy - (answer.energy >> shift) - marginOf(problem, answer.windowEnergy);
  return lead.energy > most && !isNear(problem, anchor * kOnePitch + lead.offset, answer.fit.position());
}

/// After a first step from either of two peaks of a scan: follows the one that then explains more, and the
/// other as far as it may be as good.
[[gnu::noinline]] void followEither(const Problem& problem, const Signal& signal, int anchor,
                                    const BestTwo& peaks, Contest& contest) {
  Lead lead = leadFrom(problem, signal, peaks.first.row);
  Lead rival = leadFrom(problem, signal, peaks.second.row);
  if (rival.energy > lead.energy) std::swap(lead, rival);
  contest.best.fit.start(signal, anchor, lead.row(), problem.mirrorSign());
  solve(problem, InWindow::kNearest, contest.best);
  if (!mayBeAsGood(problem, anchor, rival, contest.best, kOneStepShift)) return;
  rival = leadFrom(problem, signal, rival.row());
  if (!mayBeAsGood(problem, anchor, rival, contest.best, kTwoStepsShift)) return;
  contest.first = standingOf(problem, contest.best);
  enterFit(problem, InWindow::kNearest, anchor, rival.row(), contest);
}

/// In the window of the sharpest bend, and beside it if its answer is in doubt.
inline void searchAtBend(const Problem& problem, Contest& contest) {
  const FitTable& rows = problem.tables.rows;
  const Anchor found = deepestAnchor(problem);
  const int anchor = found.gauge;
  const Signal signal = windowSignal(problem.strains, anchor, problem.up);
  const BestTwo peaks = bestTwo(scanned<kMaxScanStep / 2, kMaxScanStep>(rows, signal, found.reach));
  if (peaks.second.energy > rivalLimit(problem, peaks.first.energy, kRivalShift)) {
    followEither(problem, signal, anchor, peaks, contest);
  } else {
    contest.best.fit.start(signal, anchor, peaks.first.row, problem.mirrorSign());
    solve(problem, InWindow::kNearest, contest.best);
  }
  if (!doubtful(problem, contest.best)) return;
  contest.first = contest.first.found ? contest.first : standingOf(problem, contest.best);
  enterBest(problem, startsBeside(problem, anchor), contest);
}

}  // namespace

Fit locate(const TableImage& tables, FitMode mode, std::span<const std::int32_t> strains_q32,
           std::uint32_t energy) {
  const Problem problem = problemOf(tables, strains_q32, energy);
  Contest contest;
  if (tables.constants.anchor_rule == AnchorRule::kExhaustive || isWeak(problem)) {
    enterBest(problem, startsAnywhere(problem), contest);
  } else {
    searchAtBend(problem, contest);
  }
  const FitMode readings =
      mode == FitMode::kRefined ? FitMode::kRefined : settledByThree(problem, contest.best);
  return reportOf(problem, contest, readings);
}

}  // namespace strainfinger::firmware
