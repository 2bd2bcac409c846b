#include "firmware/core/locate.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "firmware/core/answer.hpp"
#include "firmware/core/scan.hpp"

namespace strainfinger::firmware {
namespace {

/// A ring of less energy than 1024 variances can look right in any window, one of less than 4096 two gauges
/// away, one of less than 16,384 three.
constexpr int kWeakShift = 5;
constexpr int kAliasShift = 7;
constexpr int kFarAliasShift = 9;

// Parts of the energy, as powers of two:
constexpr int kStarterShift = 4;     ///< within 1/16 (and as many) a peak of another window may
constexpr int kRoundingShift = 12;   ///< 1/4096 is lost in rounding
constexpr int kAmbiguousShift = 14;  ///< rounding makes two fits differ by less than this
constexpr int kOneStepShift = 10;    ///< .. after a single step by less than this ..
constexpr int kTwoStepsShift = 12;   ///< .. and after a second by less than this
constexpr int kOutsideShift = 5;     ///< a contact leaves less than 1/32 of its energy outside its window

bool mayBeAlias(const Problem& problem) { return problem.ringEnergy >> kAliasShift < problem.noise; }
bool mayBeFarAlias(const Problem& problem) { return problem.ringEnergy >> kFarAliasShift < problem.noise; }
bool isWeak(const Problem& problem) { return problem.ringEnergy >> kWeakShift < problem.noise; }

/// How much less a peak of a scan may explain than the best and still win once it is refined.
std::int32_t rivalLimit(const Problem& problem, std::int32_t best, int shift) {
  return best - (best >> shift) - problem.noise;
}

/// Another window may hold a better answer.
inline bool doubtful(const Problem& problem, bool admissible, std::int32_t unexplained, std::int32_t window) {
  return !admissible || mayBeAlias(problem) || unexplained > problem.noise + (window >> kRoundingShift) ||
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

/// The best answer, in what is reported, and the next best that is not the same one.
struct Contest {
  Fit& fit;
  Standing first{}, second{};

  void enter(const Problem& problem, const WindowFit& from, const Judgement& judgement);
};

void Contest::enter(const Problem& problem, const WindowFit& from, const Judgement& judgement) {
  const Standing standing = standingOf(problem, from, judgement);
  const Placement place = placementOf(from, judgement, problem.gauges());
  const bool sameAgain = first.found && isNear(problem, place.position, fit.best.position);
  if (standing.betterThan(first)) {
    if (first.found && !sameAgain) {
      second = first;
      fit.alternative = fit.best;
    }
    first = standing;
    report(problem, from, judgement, place.position, fit);
  } else if (!sameAgain && standing.betterThan(second)) {
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
  for (int gauge = 0; gauge < problem.gauges(); ++gauge)
    list.add(scanned(rows, signalAround(problem, gauge), problem.tables.constants.scan_step), gauge);
  return list;
}

/// Contacts midway between two gauges may bend the strains most one, two or three gauges away: enters what is
/// there, on either side of the windows two gauges off, and three where noise may tip the balance.
inline void enterBeside(const Problem& problem, Contest& contest) {
  constexpr std::array<std::int8_t, 4> kAway{-2, 2, -3, 3};
  std::array<Start, 4> starts;
  const std::size_t count = mayBeFarAlias(problem) ? 4 : 2;
  std::int32_t best = 0;
  for (std::size_t i = 0; i < count; ++i) {
    starts[i] = midwayStart(problem, wrapped(contest.fit.anchor + kAway[i], problem.gauges()));
    best = std::max(best, starts[i].energy);
  }
  for (std::size_t i = 0; i < count; ++i)
    if (starts[i].energy > rivalLimit(problem, best, kStarterShift))
      enterFit(problem, InWindow::kOwn, starts[i].centre, starts[i].row, contest);
}

/// Says in the report whether the runner-up explains the readings as well, within noise.
void conclude(const Problem& problem, const Contest& contest) {
  Fit& fit = contest.fit;
  const Standing &first = contest.first, &second = contest.second;
  if (!second.found) fit.alternative = fit.best;
  fit.ambiguous = second.isRival && second.energy > first.energy - marginOf(problem, fit.windowEnergy);
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

/// What the readings' first answer leaves to be done.
enum class Task : std::uint8_t { kNone, kSearchOn, kSearchEverywhere };

/// .. of the same problem, of which its fit knows the scale.
struct Next {
  Task task = Task::kNone;
  const TableImage* tables = nullptr;
  const std::int32_t* strains_q32 = nullptr;
  std::int32_t ringEnergy = 0;

  Next() = default;
  Next(Task todo, const Problem& problem)
      : task(todo),
        tables(&problem.tables),
        strains_q32(problem.strains.data()),
        ringEnergy(problem.ringEnergy) {}
};
Problem problemAgain(const Fit& fit, const TableImage& tables, const std::int32_t* strains_q32,
                     std::int32_t ringEnergy) {
  const TableConstants& constants = tables.constants;
  return {tables, {strains_q32, constants.gauge_count}, fit.up, ringEnergy, noiseEnergy(constants, fit.up)};
}

/// Goes on from a first answer that may not be the best. If it is ambiguous so far, `alternative.position` is
/// where to look as well: an offset in its window.
[[gnu::noinline]] void searchOn(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32,
                                std::int32_t ringEnergy) {
  const Problem problem = problemAgain(fit, tables, strains_q32, ringEnergy);
  Contest contest{fit};
  const int centre = fit.centre;
  const Lead rival{fit.alternative.position, 0};
  const PitchQ20 offset = fit.offset(problem.gauges());
  if (fit.settled && absolute(offset) <= kFarFromMiddle)
    contest.first = {fit.windowEnergy - fit.unexplained + leftOutside(problem, fit.windowEnergy), true, true,
                     true};
  else
    enterFit(problem, InWindow::kNearest, centre, Lead{offset, 0}.row(), contest);
  if (fit.ambiguous) enterFit(problem, InWindow::kNearest, centre, rival.row(), contest);
  if (doubtful(problem, fit.settled, fit.unexplained, fit.windowEnergy)) enterBeside(problem, contest);
  conclude(problem, contest);
}

[[gnu::noinline]] void searchEverywhere(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32,
                                        std::int32_t ringEnergy) {
  const Problem problem = problemAgain(fit, tables, strains_q32, ringEnergy);
  Contest contest{fit};
  enterBest(problem, startsAnywhere(problem), contest);
  conclude(problem, contest);
}

bool needsEveryWindow(const Problem& problem) {
  return problem.tables.constants.anchor_rule == AnchorRule::kExhaustive || isWeak(problem);
}

/// The first answer, and what is next.
[[gnu::always_inline]] inline Next firstAnswer(const Problem& problem, Fit& fit) {
  if (needsEveryWindow(problem)) {
    fit.up = static_cast<std::int8_t>(problem.up);
    return {Task::kSearchEverywhere, problem};
  }
  Region region;
  look(problem, region);
  const Signal& signal = region.signal;
  const BestTwo& peaks = region.peaks;
  int row = peaks.first.row;
  Lead rival;
  bool contested = mayWin(problem, peaks);
  if (contested) chooseStart(problem, signal, peaks, row, rival);
  WindowFit window;
  window.start(signal, region.centre, row, problem.mirrorSign());
  const bool settled = refine(problem.tables.rows, problem.mirrorSign(), window);
  const Judgement judgement = judged(problem, window, settled);
  contested = contested &&
              staysAsGood(problem, signal,
                          {judgement.energy, judgement.windowEnergy, window.side * window.offset()}, rival);
  const bool ends =
      !contested && window.offset() <= kFarFromMiddle &&
      !doubtful(problem, judgement.admissible(), judgement.unexplained(), judgement.windowEnergy);
  const PitchQ20 position = roundTheRing(window.position(), problem.gauges());
  report(problem, window, judgement, position, fit);
  fit.alternative.position = contested ? rival.offset : position;
  fit.alternative.normal = judgement.normal;
  fit.alternative.tangential = window.side * judgement.tangential;
  fit.ambiguous = contested;
  fit.anchor = static_cast<std::uint8_t>(region.anchor);
  return ends ? Next{} : Next{Task::kSearchOn, problem};
}

}  // namespace

void locateBySeven(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32,
                   std::uint32_t energy) {
  const Next next = firstAnswer(problemOf(tables, {strains_q32, tables.constants.gauge_count}, energy), fit);
  // Calls at the end, which need no frame but their own.
  if (next.task == Task::kSearchOn) return searchOn(fit, *next.tables, next.strains_q32, next.ringEnergy);
  if (next.task == Task::kSearchEverywhere)
    return searchEverywhere(fit, *next.tables, next.strains_q32, next.ringEnergy);
}

}  // namespace strainfinger::firmware
