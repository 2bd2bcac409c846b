#include "firmware/core/locate.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace strainfinger::firmware {
namespace {

/// A scan reaches this far: a little beyond half a pitch, where the next window takes over.
constexpr int kScanReach = 36;
constexpr int kMaxScanRows = 9;

/// Fits closer than this ran into the same maximum.
constexpr PitchQ20 kSameAnswer = kOnePitch / 12;
/// Fits farther from their middle gauge than this belong to another window.
constexpr PitchQ20 kFarFromMiddle = kOnePitch * 53 / 100;

// Likelihood ratios, in variances of a reading: energy differences are log-likelihoods * 2 sigma^2.
constexpr std::uint32_t kAmbiguous = 12;    ///< answers closer than this are not told apart
constexpr std::uint32_t kRivalMargin = 32;  ///< a peak of a scan so much behind may still win once refined ..
constexpr int kRivalShift = 4;              ///< .. as may one within 1/16 of the energy
constexpr std::uint32_t kUnexplained = 32;  ///< noise alone leaves less in a window ..
constexpr int kRoundingShift = 12;          ///< .. beside 1/4096 of the energy, lost in rounding
constexpr int kAmbiguousShift = 14;    ///< rounding makes two fits differ by less of the energy than this
constexpr std::uint32_t kWeak = 1024;  ///< a ring with less energy than this can look right in a wrong window

struct Problem {
  const TableImage& tables;
  std::span<const std::int32_t> strains;
  FitMode mode;
  int shift;
  std::int32_t ringEnergy;

  FitTables fitTables() const {
    if (mode == FitMode::kRefined) return {&tables.refined, &tables.refined};
    return {&tables.three_point[kWithOffset], &tables.three_point[kAgainstOffset]};
  }
  int mirrorSign() const { return tables.constants.mirror_sign; }
  int gauges() const { return tables.constants.gauge_count; }
  std::int32_t noise(std::uint32_t variances) const;
};

/// So many variances of a reading as an energy; at least 1.
std::int32_t Problem::noise(std::uint32_t variances) const {
  const int down = 2 * shift + 2 - tables.constants.noise_variance_exponent;
  const std::uint64_t scaled = std::uint64_t{tables.constants.noise_variance} * variances;
  const std::uint64_t energy = down >= 0 ? scaled >> std::min(down, 63) : scaled << std::min(-down, 24);
  return static_cast<std::int32_t>(std::clamp<std::uint64_t>(energy, 1, 1u << 27));
}

/// The shift that brings the ring's norm just below 2^14.5.
int shiftFor(const TableConstants& constants, std::uint32_t energy) {
  const int bits = 32 - std::countl_zero(energy);
  return constants.gate_shift + bits / 2 - 14;
}

/// Energies that the seven gauges explain with the contact at each of a row of offsets, from one side of a
/// window to the other.
struct Scan {
  Signal signal{};
  int centre = 0;
  int step = 0;     ///< rows between offsets
  int perSide = 0;  ///< offsets on either side of the middle
  std::array<std::int32_t, 2 * kMaxScanRows> energy{};
  std::array<bool, 2 * kMaxScanRows> pullsBack{};  ///< the tangential load points towards the middle

  int size() const { return 2 * perSide; }
  int side(int index) const { return index < perSide ? -1 : 1; }
  int row(int index) const {
    return step / 2 + step * (index < perSide ? perSide - 1 - index : index - perSide);
  }
  std::int32_t at(int index) const { return energy[static_cast<std::size_t>(index)]; }
  std::int32_t best() const { return *std::max_element(energy.begin(), energy.begin() + size()); }
  bool isPeak(int index) const {
    return (index == 0 || at(index - 1) <= at(index)) && (index + 1 == size() || at(index + 1) < at(index));
  }
};

Scan scanWindow(const Problem& problem, int centre) {
  const TableConstants& constants = problem.tables.constants;
  Scan scan;
  scan.centre = centre;
  scan.signal = windowSignal(problem.strains, centre, problem.shift);
  scan.step = constants.scan_step;
  scan.perSide = (kScanReach - scan.step / 2) / scan.step + 1;
  for (int index = scan.perSide; index < scan.size(); ++index) {
    const auto& basis = problem.tables.refined[static_cast<std::size_t>(scan.row(index))].basis;
    const std::int32_t even1 = evenPart(basis[0], scan.signal), odd1 = oddPart(basis[0], scan.signal);
    const std::int32_t even2 = evenPart(basis[1], scan.signal), odd2 = oddPart(basis[1], scan.signal);
    const auto ahead = static_cast<std::size_t>(index);
    const auto behind = static_cast<std::size_t>(scan.size() - 1 - index);
    scan.energy[ahead] = energyOf(even1 + odd1, even2 + odd2);
    scan.energy[behind] = energyOf(even1 - odd1, even2 - odd2);
    // The second projection has the sign of the tangential load, as its own side sees it.
    scan.pullsBack[ahead] = even2 + odd2 < 0;
    scan.pullsBack[behind] = (even2 - odd2) * constants.mirror_sign < 0;
  }
  return scan;
}

/// A refined fit and how it stands against others.
struct Answer {
  WindowFit fit;
  Amplitudes amplitudes{};
  std::int32_t energy = -1;  ///< that all seven gauges say it explains
  bool settled = false;
  bool withinCone = false;  ///< presses, and no harder sideways than friction allows
  bool found = false;

  bool betterThan(const Answer& other) const {
    if (!other.found) return true;
    if (admissible() != other.admissible()) return admissible();
    return energy > other.energy;
  }
  bool admissible() const { return settled && withinCone; }
};

bool withinCone(const TableConstants& constants, const Amplitudes& amplitudes) {
  if (amplitudes.normal <= 0) return false;
  const std::int64_t limit = std::int64_t{amplitudes.normal} * constants.friction_cone_q8;
  return std::int64_t{std::abs(amplitudes.tangential)} * 256 <= limit;
}

Answer solve(const Problem& problem, const Scan& scan, int start) {
  Answer answer;
  WindowFit& fit = answer.fit;
  fit.centre = scan.centre;
  fit.side = scan.side(start);
  fit.signal = fit.side > 0 ? scan.signal : mirrored(scan.signal, problem.mirrorSign());
  fit.offset = scan.row(start) * kRowSpacing;
  fit.sense = scan.pullsBack[static_cast<std::size_t>(start)] ? kAgainstOffset : kWithOffset;
  const FitTables tables = problem.fitTables();
  answer.settled = refine(tables, problem.mirrorSign(), fit);
  answer.amplitudes = amplitudesOf(tables, fit);
  answer.withinCone = withinCone(problem.tables.constants, answer.amplitudes);
  answer.found = true;
  answer.energy = fit.energy;
  if (problem.mode == FitMode::kThreePoint)
    answer.energy = fitStep(problem.tables.refined[static_cast<std::size_t>(fit.row)], fit.signal).energy;
  return answer;
}

PitchQ20 roundTheRing(PitchQ20 position, int gauges) {
  const PitchQ20 ring = gauges * kOnePitch;
  if (position < 0) return position + ring;
  return position >= ring ? position - ring : position;
}

PitchQ20 distance(const Answer& a, const Answer& b, int gauges) {
  const PitchQ20 ahead = roundTheRing(a.fit.position() - b.fit.position(), gauges);
  return std::min(ahead, gauges * kOnePitch - ahead);
}

/// The two best answers that are not the same one.
struct Contest {
  Answer best;
  Answer second;

  void enter(const Answer& answer, int gauges) {
    if (best.found && distance(answer, best, gauges) < kSameAnswer) {
      if (answer.betterThan(best)) best = answer;
      return;
    }
    if (answer.betterThan(best)) {
      second = best;
      best = answer;
    } else if (answer.betterThan(second)) {
      second = answer;
    }
  }
};

/// Refines every peak of a scan that may yet turn out the best.
void solveWindow(const Problem& problem, const Scan& scan, Contest& contest) {
  const std::int32_t best = scan.best();
  const std::int32_t limit = best - (best >> kRivalShift) - problem.noise(kRivalMargin);
  for (int start = 0; start < scan.size(); ++start) {
    if (scan.isPeak(start) && scan.at(start) > limit)
      contest.enter(solve(problem, scan, start), problem.gauges());
  }
}

bool doubtful(const Problem& problem, const Answer& answer) {
  const std::int32_t window = energyOf(answer.fit.signal);
  const std::int32_t noise = problem.noise(kUnexplained);
  return !answer.admissible() || problem.ringEnergy < problem.noise(kWeak) ||
         std::abs(answer.fit.offset) > kFarFromMiddle ||
         window - answer.energy > noise + (window >> kRoundingShift) ||
         problem.ringEnergy - window > noise + (window >> 3);
}

int bendAnchor(const Problem& problem) {
  int best = 0;
  std::int64_t largest = std::numeric_limits<std::int64_t>::min();
  for (int gauge = 0; gauge < problem.gauges(); ++gauge) {
    const auto at = [&](int index) {
      return std::int64_t{problem.strains[static_cast<std::size_t>(wrapped(index, problem.gauges()))]};
    };
    const std::int64_t bend =
        (at(gauge - 1) - 2 * at(gauge) + at(gauge + 1)) * problem.tables.constants.anchor_sign;
    if (bend > largest) {
      largest = bend;
      best = gauge;
    }
  }
  return best;
}

/// Of the windows at `offsets` from the anchor, solves the one whose scan explains most.
template <std::size_t N>
void solveBestOf(const Problem& problem, int anchor, const std::array<int, N>& offsets, Contest& contest) {
  Scan best;
  for (const int offset : offsets) {
    const Scan scan = scanWindow(problem, wrapped(anchor + offset, problem.gauges()));
    if (best.step == 0 || scan.best() > best.best()) best = scan;
  }
  solveWindow(problem, best, contest);
}

/// Where the model's strongest response has no single peak over the contact, every window is looked at.
void solveEverywhere(const Problem& problem, Contest& contest) {
  std::array<std::int32_t, kMaxGauges> energies{};
  std::int32_t largest = 0;
  for (int gauge = 0; gauge < problem.gauges(); ++gauge) {
    energies[static_cast<std::size_t>(gauge)] = scanWindow(problem, gauge).best();
    largest = std::max(largest, energies[static_cast<std::size_t>(gauge)]);
  }
  const std::int32_t limit = largest - (largest >> kRivalShift) - problem.noise(kRivalMargin);
  for (int gauge = 0; gauge < problem.gauges(); ++gauge) {
    if (energies[static_cast<std::size_t>(gauge)] >= limit)
      solveWindow(problem, scanWindow(problem, gauge), contest);
  }
}

Contest decide(const Problem& problem) {
  Contest contest;
  if (problem.tables.constants.anchor_rule == AnchorRule::kExhaustive) {
    solveEverywhere(problem, contest);
    return contest;
  }
  const int anchor = bendAnchor(problem);
  solveWindow(problem, scanWindow(problem, anchor), contest);
  if (doubtful(problem, contest.best)) solveBestOf(problem, anchor, std::array{-3, -2, 2, 3}, contest);
  return contest;
}

Placement placementOf(const Answer& answer, int gauges) {
  return {roundTheRing(answer.fit.position(), gauges), answer.amplitudes.normal,
          answer.fit.side * answer.amplitudes.tangential};
}

Fit reportOf(const Problem& problem, const Contest& contest) {
  const Answer& best = contest.best;
  const FitRow& row = (*problem.fitTables()[best.fit.sense])[static_cast<std::size_t>(best.fit.row)];
  const std::int32_t window = energyOf(best.fit.signal);
  Fit fit;
  fit.best = placementOf(best, problem.gauges());
  fit.alternative = contest.second.found ? placementOf(contest.second, problem.gauges()) : fit.best;
  const std::int32_t margin = problem.noise(kAmbiguous) + (window >> kAmbiguousShift);
  fit.ambiguous =
      contest.second.found && contest.second.withinCone && contest.second.energy > best.energy - margin;
  fit.settled = best.admissible();
  fit.normalSlope = best.amplitudes.normalSlope;
  fit.tangentialSlope = best.amplitudes.tangentialSlope;
  fit.information = best.fit.information;
  fit.informationExponent = row.gradient_exponent;
  fit.load = row.load;
  fit.shift = static_cast<std::int8_t>(problem.shift);
  fit.centre = static_cast<std::uint8_t>(best.fit.centre);
  fit.unexplained = std::max(window - best.energy, 0);
  fit.expected = problem.noise(kUnexplained / 2) + (window >> kRoundingShift);
  return fit;
}

}  // namespace

Fit locate(const TableImage& tables, FitMode mode, std::span<const std::int32_t> strains_q32,
           std::uint32_t energy) {
  const int shift = shiftFor(tables.constants, energy);
  const int down = 2 * (shift - tables.constants.gate_shift) + 2;
  const auto ringEnergy = static_cast<std::int32_t>(down >= 0 ? energy >> down : energy << -down);
  const Problem problem{tables, strains_q32, mode, shift, ringEnergy};
  const Contest contest = decide(problem);
  // Three readings that leave much unexplained are overruled by their neighbours.
  if (mode == FitMode::kThreePoint && doubtful(problem, contest.best))
    return locate(tables, FitMode::kRefined, strains_q32, energy);
  return reportOf(problem, contest);
}

}  // namespace strainfinger::firmware
