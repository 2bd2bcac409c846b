#include "firmware/core/locate.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "firmware/core/answer.hpp"
#include "firmware/core/scan.hpp"

namespace strainfinger::firmware {
namespace {

/// A ring of less energy than 1024 variances can look right in any window, one of less than 4096 two or three
/// gauges away.
constexpr int kWeakShift = 5;
constexpr int kAliasShift = 7;

// Parts of the energy, as powers of two:
constexpr int kStarterShift = 4;     ///< within 1/16 (and as many) a peak of another window may
constexpr int kRoundingShift = 12;   ///< 1/4096 is lost in rounding
constexpr int kAmbiguousShift = 14;  ///< rounding makes two fits differ by less than this
constexpr int kOneStepShift = 10;    ///< .. after a single step by less than this ..
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

/// Refines a fit from a row of a window and enters it, in a frame of its own.
[[gnu::noinline]] void enterFit(const Problem& problem, InWindow window, int centre, int row,
                                Contest& contest) {
  Answer answer;
  answer.fit.start(signalAround(problem, centre), centre, row, problem.mirrorSign());
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
    const Signal signal = signalAround(problem, gauge);
    if (finely) list.add(scanned<kMinScanStep / 2, kMinScanStep>(rows, signal), gauge);
    if (!finely) list.add(scanned<kMaxScanStep / 2, kMaxScanStep>(rows, signal), gauge);
  }
  return list;
}

/// Contacts midway between two gauges may bend the strains most one, two or three gauges away: enters what is
/// there, on either side of the windows two gauges off, and three where noise may tip the balance.
inline void enterBeside(const Problem& problem, const Region& region, Contest& contest) {
  constexpr std::array<std::int8_t, 4> kAway{-2, 2, -3, 3};
  std::array<Start, 4> starts;
  std::size_t count = 2;
  if (region.lookedBeside && !mayBeAlias(problem)) {
    std::copy(region.besides.begin(), region.besides.end(), starts.begin());
  } else {
    count = mayBeAlias(problem) ? 4 : 2;
    for (std::size_t i = 0; i < count; ++i)
      starts[i] = midwayStart(problem, wrapped(region.anchor + kAway[i], problem.gauges()));
  }
  std::int32_t best = 0;
  for (std::size_t i = 0; i < count; ++i) best = std::max(best, starts[i].energy);
  for (std::size_t i = 0; i < count; ++i)
    if (starts[i].energy > rivalLimit(problem, best, kStarterShift))
      enterFit(problem, InWindow::kOwn, starts[i].centre, starts[i].row, contest);
}

/// The runner-up explains the readings as well, within noise.
bool isAmbiguous(const Problem& problem, const Contest& contest) {
  return contest.second.isRival &&
         contest.second.energy > contest.first.energy - marginOf(problem, contest.best.windowEnergy);
}

inline Fit reportOf(const Problem& problem, const Answer& best) {
  const Placement placement = best.placement(problem.gauges());
  Fit fit;
  fit.best = fit.alternative = placement;
  fit.row = unknown(problem.tables.rows.data()) + best.fit.row;
  fit.projection = best.fit.step.projection;
  fit.information = best.fit.step.information;
  fit.unexplained = best.windowEnergy - best.energy;
  fit.windowEnergy = best.windowEnergy;
  fit.up = static_cast<std::int8_t>(problem.up);
  fit.centre = static_cast<std::uint8_t>(best.fit.centre);
  fit.readings = FitMode::kRefined;
  fit.ambiguous = fit.reduced = false;
  fit.settled = best.admissible() && best.energy >> 1 > problem.noise;  // 64 variances
  return fit;
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

/// Of an answer what a rival is compared with; `offset` as a lead's.
struct ToBeat {
  std::int32_t energy, windowEnergy;
  PitchQ20 offset;
};

/// Whether what a lead leads to may be another answer, as good: it explains what the answer does but for
/// noise and 1/2^shift.
bool mayBeAsGood(const Problem& problem, const Lead& lead, const ToBeat& answer, int shift) {
  const std::int32_t most = answer.energy - (answer.energy >> shift) - marginOf(problem, answer.windowEnergy);
  return lead.energy > most && !isNear(problem, lead.offset, answer.offset);
}

/// Two peaks of a scan, of which either may be the better: a first step tells where to start, and where the
/// other leads.
[[gnu::noinline]] void chooseStart(const Problem& problem, const Signal& signal, const BestTwo& peaks,
                                   int& row, Lead& rival) {
  row = peaks.first.row;
  rival = leadFrom(problem, signal, peaks.second.row);
  if (rival.energy <= peaks.first.energy) return;  // which a step from there only adds to
  const Lead first = leadFrom(problem, signal, row);
  const bool swaps = rival.energy > first.energy;
  row = (swaps ? rival : first).row();
  if (swaps) rival = first;
}

/// A rival may still be as good as the answer once another step is taken.
[[gnu::noinline]] bool staysAsGood(const Problem& problem, const Signal& signal, const ToBeat& answer,
                                   Lead& rival) {
  if (!mayBeAsGood(problem, rival, answer, kOneStepShift)) return false;
  rival = leadFrom(problem, signal, rival.row());
  return mayBeAsGood(problem, rival, answer, kTwoStepsShift);
}

Fit reportOf(const Problem& problem, const Contest& contest) {
  Fit fit = reportOf(problem, contest.best);
  if (contest.second.found) {
    fit.alternative = contest.secondPlacement;
    fit.ambiguous = isAmbiguous(problem, contest);
  }
  return fit;
}

/// What a search at the anchor comes to that the first answer doesn't end.
[[gnu::noinline]] Fit searchedOn(const Problem& problem, const Region& region, const int* rivalRow,
                                 Answer& answer) {
  Contest contest{answer, {}, {}, {}};
  if (answer.fit.offset() > kFarFromMiddle) solve(problem, InWindow::kNearest, answer);
  if (rivalRow != nullptr) {
    contest.first = standingOf(problem, answer);
    enterFit(problem, InWindow::kNearest, region.centre, *rivalRow, contest);
  }
  if (doubtful(problem, answer)) {
    contest.first = contest.first.found ? contest.first : standingOf(problem, answer);
    enterBeside(problem, region, contest);
  }
  return reportOf(problem, contest);
}

/// `answer`: room for one.
[[gnu::noinline]] Fit searchedEverywhere(const Problem& problem, Answer& answer) {
  Contest contest{answer, {}, {}, {}};
  enterBest(problem, startsAnywhere(problem), contest);
  return reportOf(problem, contest);
}

}  // namespace

Fit locateBySeven(const TableImage& tables, std::span<const std::int32_t> strains_q32, std::uint32_t energy) {
  const Problem problem = problemOf(tables, strains_q32, energy);
  Answer answer;
  if (tables.constants.anchor_rule == AnchorRule::kExhaustive || isWeak(problem))
    return searchedEverywhere(problem, answer);
  Region region;
  look(problem, region);
  const Signal& signal = region.signal;
  const BestTwo& peaks = region.peaks;
  int row = peaks.first.row;
  Lead rival;
  bool contested = mayWin(problem, peaks);
  if (contested) chooseStart(problem, signal, peaks, row, rival);
  answer.fit.start(signal, region.centre, row, problem.mirrorSign());
  answer.settled = refine(tables.rows, problem.mirrorSign(), answer.fit);
  judge(problem, answer);
  contested = contested &&
              staysAsGood(problem, signal,
                          {answer.energy, answer.windowEnergy, answer.fit.side * answer.fit.offset()}, rival);
  if (!contested && answer.fit.offset() <= kFarFromMiddle && !doubtful(problem, answer))
    return reportOf(problem, answer);
  const int rivalRow = contested ? rival.row() : 0;
  return searchedOn(problem, region, contested ? &rivalRow : nullptr, answer);
}

}  // namespace strainfinger::firmware
