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
constexpr int kRivalShift =
    5;  ///< a peak of one window within 1/32 (and kNoiseUnit variances) may yet win ..
constexpr int kStarterShift = 4;     ///< .. and one of another window within 1/16
constexpr int kRoundingShift = 12;   ///< 1/4096 is lost in rounding
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

/// Refines every start of the list that may win.
[[gnu::noinline]] void enterBest(const Problem& problem, const Shortlist& list, Contest& contest) {
  const std::int32_t limit = rivalLimit(problem, list.starts()[0].energy, kStarterShift);
  for (const Start& from : list.starts()) {
    if (from.energy <= limit) return;
    Answer answer;
    answer.fit.start(windowSignal(problem.strains, from.centre, problem.up), from.centre, from.row,
                     problem.mirrorSign());
    solve(problem, InWindow::kOwn, answer);
    contest.enter(problem, answer);
  }
}

/// Where the model's strongest response has no single peak over the contact, or noise may hide it, every
/// window is looked at.
[[gnu::noinline]] void searchEverywhere(const Problem& problem, Contest& contest) {
  Shortlist list;
  const FitTable& rows = problem.tables.rows;
  const bool finely = problem.tables.constants.scan_step == kMinScanStep;
  for (int gauge = 0; gauge < problem.gauges(); ++gauge) {
    const Signal signal = windowSignal(problem.strains, gauge, problem.up);
    if (finely) list.add(scanned<kMinScanStep / 2, kMinScanStep>(rows, signal), gauge);
    if (!finely) list.add(scanned<kMaxScanStep / 2, kMaxScanStep>(rows, signal), gauge);
  }
  enterBest(problem, list, contest);
}

/// Contacts midway between two gauges may bend the strains most one, two or three gauges away: looks there,
/// on either side of the windows two gauges off, and three where noise may tip the balance.
[[gnu::noinline]] void searchBeside(const Problem& problem, int anchor, Contest& contest) {
  constexpr std::array kAway{-2, 2, -3, 3};
  Shortlist list;
  for (std::size_t i = 0; i < (mayBeAlias(problem) ? kAway.size() : 2); ++i) {
    const int centre = wrapped(anchor + kAway[i], problem.gauges());
    const Signal signal = windowSignal(problem.strains, centre, problem.up);
    list.add(bestTwo(scanned<20, kMaxScanStep>(problem.tables.rows, signal)).first, centre);
  }
  enterBest(problem, list, contest);
}

inline Fit reportOf(const Problem& problem, const Answer& best, FitMode readings) {
  const Placement placement = best.placement(problem.gauges());
  return {.best = placement,
          .alternative = placement,
          .row = &problem.tables.rows[static_cast<std::size_t>(best.fit.row)],
          .projection = best.fit.step.projection,
          .information = best.fit.step.information,
          .unexplained = best.windowEnergy - best.energy,
          .windowEnergy = best.windowEnergy,
          .up = static_cast<std::int8_t>(problem.up),
          .centre = static_cast<std::uint8_t>(best.fit.centre),
          .readings = readings,
          .ambiguous = false,
          .settled = best.admissible() && best.energy >> 1 > problem.noise};  // 64 variances
}

Fit reportOf(const Problem& problem, const Contest& contest, FitMode readings) {
  Fit fit = reportOf(problem, contest.best, readings);
  if (!contest.second.found) return fit;
  fit.alternative = contest.secondPlacement;
  fit.ambiguous = contest.second.isRival &&
                  contest.second.energy > contest.first.energy - marginOf(problem, contest.best.windowEnergy);
  return fit;
}

/// Leaves the answer to three readings if the mode says so and they lead where all seven do.
[[gnu::noinline]] FitMode settleReadings(const Problem& problem, FitMode mode, Answer& answer) {
  if (mode == FitMode::kRefined || !answer.admissible()) return FitMode::kRefined;
  WindowFit fit = answer.fit;
  if (!solveTriple(problem.tables.rows, problem.mirrorSign(), fit)) return FitMode::kRefined;
  answer.fit = fit;
  answer.amplitudes = amplitudesOf(problem.tables.rows[static_cast<std::size_t>(fit.row)], fit.step);
  return FitMode::kThreePoint;
}

/// An answer that nothing speaks against.
inline Fit settled(const Problem& problem, FitMode mode, Answer& answer) {
  const FitMode readings =
      mode == FitMode::kRefined ? FitMode::kRefined : settleReadings(problem, mode, answer);
  return reportOf(problem, answer, readings);
}

[[gnu::noinline]] Fit locateAnywhere(const Problem& problem, FitMode mode) {
  Contest contest;
  searchEverywhere(problem, contest);
  const FitMode readings = settleReadings(problem, mode, contest.best);
  return reportOf(problem, contest, readings);
}

/// Looks beside the anchor's window if its best answer is in doubt.
[[gnu::noinline]] Fit decide(const Problem& problem, FitMode mode, int anchor, Contest& contest) {
  if (doubtful(problem, contest.best)) searchBeside(problem, anchor, contest);
  const FitMode readings = settleReadings(problem, mode, contest.best);
  return reportOf(problem, contest, readings);
}

[[gnu::noinline]] Fit decide(const Problem& problem, FitMode mode, int anchor, const Answer& answer) {
  Contest contest;
  contest.enter(problem, answer);
  return decide(problem, mode, anchor, contest);
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
[[gnu::noinline]] Fit locateRivalled(const Problem& problem, FitMode mode, const Signal& signal, int anchor,
                                     const BestTwo& peaks) {
  Lead lead = leadFrom(problem, signal, peaks.first.row);
  Lead rival = leadFrom(problem, signal, peaks.second.row);
  if (rival.energy > lead.energy) std::swap(lead, rival);
  Answer answer;
  answer.fit.start(signal, anchor, lead.row(), problem.mirrorSign());
  solve(problem, InWindow::kNearest, answer);
  if (mayBeAsGood(problem, anchor, rival, answer, kOneStepShift)) {
    rival = leadFrom(problem, signal, rival.row());
    if (mayBeAsGood(problem, anchor, rival, answer, kTwoStepsShift)) {
      Contest contest;
      contest.enter(problem, answer);
      answer.fit.start(signal, anchor, rival.row(), problem.mirrorSign());
      solve(problem, InWindow::kNearest, answer);
      contest.enter(problem, answer);
      return decide(problem, mode, anchor, contest);
    }
  }
  if (doubtful(problem, answer)) return decide(problem, mode, anchor, answer);
  return settled(problem, mode, answer);
}

}  // namespace

Fit locate(const TableImage& tables, FitMode mode, std::span<const std::int32_t> strains_q32,
           std::uint32_t energy) {
  const Problem problem = problemOf(tables, strains_q32, energy);
  if (tables.constants.anchor_rule == AnchorRule::kExhaustive || isWeak(problem))
    return locateAnywhere(problem, mode);
  const int anchor = bendAnchor(problem);
  const Signal signal = windowSignal(strains_q32, anchor, problem.up);
  const BestTwo peaks = bestTwo(scanned<kMaxScanStep / 2, kMaxScanStep>(tables.rows, signal));
  if (peaks.second.energy > rivalLimit(problem, peaks.first.energy, kRivalShift))
    return locateRivalled(problem, mode, signal, anchor, peaks);
  Answer answer;
  answer.fit.start(signal, anchor, peaks.first.row, problem.mirrorSign());
  solve(problem, InWindow::kNearest, answer);
  if (doubtful(problem, answer)) return decide(problem, mode, anchor, answer);
  return settled(problem, mode, answer);
}

}  // namespace strainfinger::firmware
