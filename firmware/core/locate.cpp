#include "firmware/core/locate.hpp"

#include "firmware/core/answer.hpp"
#include "firmware/core/doubt.hpp"
#include "firmware/core/scan.hpp"

namespace strainfinger::firmware {
namespace {

// Parts of the energy, as powers of two, that a lead may gain yet:
constexpr int kOneStepShift = 10;   ///< after a single step
constexpr int kTwoStepsShift = 12;  ///< after a second

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
  const std::int32_t most =
      answer.energy - (answer.energy >> shift) - coveredMargin(problem, answer.windowEnergy);
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

/// .. of the same problem, of which the fit knows the scale.
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
bool needsEveryWindow(const Problem& problem) {
  return problem.tables.constants.anchor_rule == AnchorRule::kExhaustive || isWeak(problem);
}

/// Not nearer to another gauge, and no other place across its own gauge that noise may hide.
[[gnu::always_inline]] inline bool staysWhereItIs(const Problem& problem, PitchQ20 offset) {
  if (offset >= kBesideGauge) return offset <= kFarFromMiddle;
  return !mayBeHidden(problem, offset);
}

/// Where the first fit starts: at the row that the pairs beside the deepest reading tell.
[[gnu::always_inline]] inline void startAsTold(const Problem& problem, const Deepest& deepest,
                                               const StartWeights& weights, Region& region, int& row) {
  region.anchor = region.centre = deepest.gauge;
  region.signal = windowSignal(problem.strains, deepest.gauge, problem.up);
  row = toldRow(weights, region.signal);
}

/// .. or at the best peak of a scan. Whether it has a rival.
[[gnu::always_inline]] inline bool startAtPeak(const Problem& problem, const Deepest& deepest, Region& region,
                                               int& row, Lead& rival) {
  look(problem, deepest, region);
  const BestTwo& peaks = region.peaks;
  row = peaks.first.row;
  if (!mayWin(problem, peaks)) return false;
  chooseStart(problem, region.signal, peaks, row, rival);
  return true;
}

/// The first answer, and what is next. Of firm contacts whose place is told no scan is made, if a fit from
/// there explains the readings.
[[gnu::always_inline]] inline Next firstAnswer(const Problem& problem, Fit& fit) {
  if (needsEveryWindow(problem)) {
    fit.up = static_cast<std::int8_t>(problem.up);
    return {Task::kSearchEverywhere, problem};
  }
  const Deepest deepest = deepestOf(problem);
  const StartWeights& weights = startWeights(problem, deepest);
  Region region;
  for (bool told = isFirm(problem) && weights.tell();; told = false) {
    int row = 0;
    Lead rival;
    bool contested = false;
    if (told)
      startAsTold(problem, deepest, weights, region, row);
    else
      contested = startAtPeak(problem, deepest, region, row, rival);
    WindowFit window;
    window.start(region.signal, region.centre, row, problem.mirrorSign());
    const bool settled = refine(problem.tables.rows, problem.mirrorSign(), window);
    const Judgement judgement = judged(problem, window, settled);
    const ToBeat answer{judgement.energy, judgement.windowEnergy, window.side * window.offset()};
    contested = contested && staysAsGood(problem, region.signal, answer, rival);
    const bool doubt =
        doubtful(problem, judgement.admissible(), judgement.unexplained(), judgement.windowEnergy);
    if (told && doubt) continue;
    const PitchQ20 position = roundTheRing(window.position(), problem.gauges());
    report(problem, window, judgement, position, fit);
    fit.alternative.position = contested ? rival.offset : position;
    fit.alternative.normal = judgement.normal;
    fit.alternative.tangential = window.side * judgement.tangential;
    fit.ambiguous = contested;
    fit.deficit = kNoRival;
    fit.anchor = static_cast<std::uint8_t>(region.anchor);
    const bool ends = !contested && !doubt && staysWhereItIs(problem, window.offset());
    return ends ? Next{} : Next{Task::kSearchOn, problem};
  }
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
