#include "firmware/core/locate.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "firmware/core/answer.hpp"
#include "firmware/core/scan.hpp"

namespace strainfinger::firmware {
namespace {

/// Fits farther from their middle gauge than this belong to another window.
constexpr PitchQ20 kFarFromMiddle = kOnePitch * 53 / 100;

// In variances of a reading (Problem::noise()):
constexpr std::uint32_t kAmbiguous = 12;    ///< answers closer than this are not told apart
constexpr std::uint32_t kRivalMargin = 32;  ///< a peak of a scan so far behind may still win once refined ..
constexpr std::uint32_t kUnexplained = 32;  ///< noise alone leaves less in a window ..
constexpr std::uint32_t kAlias = 4096;      ///< a ring with less can look right two or three gauges away
constexpr std::uint32_t kWeak = 1024;       ///< .. and with less than this, in any
constexpr std::uint32_t kAmbiguousWeak = 24;  ///< kAmbiguous there, where the energy is far from quadratic
constexpr std::uint32_t kFaint = 64;          ///< an answer that explains less than this may be noise
// .. and in parts of the energy, as powers of two:
constexpr int kRivalShift = 4;       ///< .. as may one within 1/16
constexpr int kRoundingShift = 12;   ///< .. beside 1/4096, lost in rounding
constexpr int kAmbiguousShift = 14;  ///< rounding makes two fits differ by less than this
constexpr int kOutsideShift = 3;     ///< a contact leaves less than 1/8 of its energy outside its window

bool isWeak(const Problem& problem) { return problem.ringEnergy < problem.noise(kWeak); }

/// Refines every peak of a scan that may yet turn out the best.
void solveWindow(const Problem& problem, const Scan& scan, Contest& contest) {
  const std::int32_t best = scan.best();
  const std::int32_t limit = best - (best >> kRivalShift) - problem.noise(kRivalMargin);
  for (int start = 0; start < scan.size(); ++start) {
    if (scan.isPeak(start) && scan.at(start) > limit)
      contest.enter(solve(problem, scan, start), problem.gauges());
  }
}

/// Another window may hold a better answer.
bool doubtful(const Problem& problem, const Answer& answer) {
  const std::int32_t window = energyOf(answer.fit.signal);
  const std::int32_t noise = problem.noise(kUnexplained);
  return !answer.standing.admissible || problem.ringEnergy < problem.noise(kAlias) ||
         std::abs(answer.fit.offset) > kFarFromMiddle ||
         window - answer.energy > noise + (window >> kRoundingShift) ||
         problem.ringEnergy - window > noise + (window >> kOutsideShift);
}

/// Of the windows at `offsets` from the anchor, solves the one whose scan explains most. Scans that one
/// twice, so as to have one scan on the stack and not two.
template <std::size_t N>
void solveBestOf(const Problem& problem, int anchor, const std::array<int, N>& offsets, Contest& contest) {
  int best = anchor;
  std::int32_t most = -1;
  for (const int offset : offsets) {
    const int gauge = wrapped(anchor + offset, problem.gauges());
    const std::int32_t energy = scanWindow(problem, gauge).best();
    if (energy <= most) continue;
    most = energy;
    best = gauge;
  }
  solveWindow(problem, scanWindow(problem, best), contest);
}

/// Where the model's strongest response has no single peak over the contact, or noise may hide it, every
/// window is looked at.
void solveEverywhere(const Problem& problem, Contest& contest) {
  constexpr int kCoarse = 11;  // energies, below 2^27, in 16 bits: half the stack
  std::array<std::uint16_t, kMaxGauges> energies{};
  std::int32_t largest = 0;
  for (int gauge = 0; gauge < problem.gauges(); ++gauge) {
    const std::int32_t energy = scanWindow(problem, gauge).best();
    energies[static_cast<std::size_t>(gauge)] = saturate<std::uint16_t>(energy >> kCoarse);
    largest = std::max(largest, energy);
  }
  const std::int32_t limit = largest - (largest >> kRivalShift) - problem.noise(kRivalMargin);
  for (int gauge = 0; gauge < problem.gauges(); ++gauge) {
    if (energies[static_cast<std::size_t>(gauge)] >= limit >> kCoarse)
      solveWindow(problem, scanWindow(problem, gauge), contest);
  }
}

/// The answers of one mode.
Contest contestOf(const Problem& problem) {
  Contest contest;
  if (problem.tables.constants.anchor_rule == AnchorRule::kExhaustive || isWeak(problem)) {
    solveEverywhere(problem, contest);
    return contest;
  }
  const int anchor = bendAnchor(problem);
  solveWindow(problem, scanWindow(problem, anchor), contest);
  const WindowFit& first = contest.best.fit;
  if (std::abs(first.offset) > kFarFromMiddle)
    solveWindow(problem, scanWindow(problem, wrapped(first.centre + first.side, problem.gauges())), contest);
  if (doubtful(problem, contest.best)) solveBestOf(problem, anchor, std::array{-3, -2, 2, 3}, contest);
  return contest;
}

Fit reportOf(const Problem& problem, const Contest& contest) {
  const Answer& best = contest.best;
  const FitRow& row = (*problem.fitTables()[best.fit.sense])[static_cast<std::size_t>(best.fit.row)];
  const std::int32_t window = energyOf(best.fit.signal);
  Fit fit;
  fit.best = best.placement(problem.gauges());
  fit.alternative = contest.second.found ? contest.secondPlacement : fit.best;
  const std::int32_t margin =
      problem.noise(isWeak(problem) ? kAmbiguousWeak : kAmbiguous) + (window >> kAmbiguousShift);
  fit.ambiguous = contest.second.isRival && contest.second.energy > best.standing.energy - margin;
  fit.settled = best.standing.admissible && best.energy > problem.noise(kFaint);
  fit.normalSlope = best.amplitudes.normalSlope;
  fit.tangentialSlope = best.amplitudes.tangentialSlope;
  fit.information = best.fit.information;
  fit.informationExponent = row.gradient_exponent;
  fit.load = row.load;
  fit.shift = static_cast<std::int8_t>(problem.shift);
  fit.centre = static_cast<std::uint8_t>(best.fit.centre);
  fit.side = static_cast<std::int8_t>(best.fit.side);
  fit.unexplained = std::max<std::int32_t>(window - best.energy, 0);
  fit.expected = problem.noise(kUnexplained / 2) + (window >> kRoundingShift);
  return fit;
}

}  // namespace

Fit locate(const TableImage& tables, FitMode mode, std::span<const std::int32_t> strains_q32,
           std::uint32_t energy) {
  {
    const Problem problem = problemOf(tables, mode, strains_q32, energy);
    const Contest contest = contestOf(problem);
    if (mode == FitMode::kRefined || !doubtful(problem, contest.best)) return reportOf(problem, contest);
  }  // its stack is needed again
  // Three readings that leave much unexplained are overruled by their neighbours.
  const Problem refined = problemOf(tables, FitMode::kRefined, strains_q32, energy);
  return reportOf(refined, contestOf(refined));
}

}  // namespace strainfinger::firmware
