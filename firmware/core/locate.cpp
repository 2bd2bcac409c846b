#include "firmware/core/locate.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace strainfinger::firmware {
namespace {

/// Rows at which a window is scanned: odd sixteenths of a pitch. The best of either side leads to the truth.
constexpr std::array<int, 5> kScanRows{4, 12, 20, 28, 36};

/// Fits closer than this ran into the same maximum.
constexpr PitchQ20 kSameAnswer = kOnePitch / 12;
/// Fits farther from their middle gauge than this belong to another window.
constexpr PitchQ20 kFarFromMiddle = kOnePitch * 53 / 100;

// Likelihood ratios, in variances of a reading: energy differences are log-likelihoods * 2 sigma^2.
constexpr std::uint32_t kAmbiguous = 12;    ///< answers closer than this are not told apart
constexpr std::uint32_t kRivalMargin = 32;  ///< a start so much behind may still win once refined ..
constexpr int kRivalShift = 4;              ///< .. as may one within 1/16 of the energy
constexpr std::uint32_t kUnexplained = 32;  ///< noise alone leaves less in a window ..
constexpr int kRoundingShift = 12;          ///< .. beside 1/4096 of the energy, lost in rounding

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

/// Where a fit may start, and what the scan saw there.
struct Start {
  int row = 0;
  std::int32_t energy = -1;
  FitSense sense = kWithOffset;
  bool isPeak = false;  ///< not merely the flank of the other side's maximum
};

struct Scan {
  Signal signal{};
  int centre = 0;
  std::array<Start, 2> side;  ///< offsets towards +theta, towards -theta

  int leader() const { return side[1].energy > side[0].energy ? 1 : 0; }
  std::int32_t energy() const { return side[static_cast<std::size_t>(leader())].energy; }
};

Scan scanWindow(const Problem& problem, int centre) {
  Scan scan;
  scan.centre = centre;
  scan.signal = windowSignal(problem.strains, centre, problem.shift);
  std::array<std::int32_t, 2> nextToMiddle{};
  for (const int row : kScanRows) {
    const auto& basis = problem.tables.refined[static_cast<std::size_t>(row)].basis;
    const std::int32_t even1 = evenPart(basis[0], scan.signal), odd1 = oddPart(basis[0], scan.signal);
    const std::int32_t even2 = evenPart(basis[1], scan.signal), odd2 = oddPart(basis[1], scan.signal);
    const std::array<std::int32_t, 2> energy{energyOf(even1 + odd1, even2 + odd2),
                                             energyOf(even1 - odd1, even2 - odd2)};
    if (row == kScanRows.front()) nextToMiddle = energy;
    // The second projection has the sign of the tangential load, as its own side sees it.
    const std::array<bool, 2> against{even2 + odd2 < 0, (even2 - odd2) * problem.mirrorSign() < 0};
    for (std::size_t side = 0; side < 2; ++side) {
      if (energy[side] > scan.side[side].energy)
        scan.side[side] = {row, energy[side], against[side] ? kAgainstOffset : kWithOffset, false};
    }
  }
  for (std::size_t side = 0; side < 2; ++side) {
    scan.side[side].isPeak =
        scan.side[side].row != kScanRows.front() || nextToMiddle[side] >= nextToMiddle[1 - side];
  }
  return scan;
}

/// A refined fit and how it stands against others.
struct Answer {
  WindowFit fit;
  Amplitudes amplitudes{};
  std::int32_t energy = -1;  ///< that all seven gauges say it explains
  bool admissible = false;   ///< presses, within the friction cone
  bool found = false;

  bool betterThan(const Answer& other) const {
    if (!other.found) return true;
    if (admissible != other.admissible) return admissible;
    return energy > other.energy;
  }
};

bool withinCone(const TableConstants& constants, const Amplitudes& amplitudes) {
  if (amplitudes.normal <= 0) return false;
  const std::int64_t limit = std::int64_t{amplitudes.normal} * constants.friction_cone_q8;
  return std::int64_t{std::abs(amplitudes.tangential)} * 256 <= limit;
}

Answer solve(const Problem& problem, const Scan& scan, int side) {
  Answer answer;
  WindowFit& fit = answer.fit;
  fit.centre = scan.centre;
  fit.side = side == 0 ? 1 : -1;
  fit.signal = side == 0 ? scan.signal : mirrored(scan.signal, problem.mirrorSign());
  fit.offset = scan.side[static_cast<std::size_t>(side)].row * kRowSpacing;
  const FitTables tables = problem.fitTables();
  fit.sense = scan.side[static_cast<std::size_t>(side)].sense;
  refine(tables, problem.mirrorSign(), fit);
  answer.amplitudes = amplitudesOf(tables, fit);
  answer.admissible = withinCone(problem.tables.constants, answer.amplitudes);
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

void solveWindow(const Problem& problem, const Scan& scan, Contest& contest) {
  const int lead = scan.leader();
  contest.enter(solve(problem, scan, lead), problem.gauges());
  const Start& rival = scan.side[static_cast<std::size_t>(1 - lead)];
  const std::int32_t margin = (scan.energy() >> kRivalShift) + problem.noise(kRivalMargin);
  if (rival.isPeak && rival.energy > scan.energy() - margin)
    contest.enter(solve(problem, scan, 1 - lead), problem.gauges());
}

bool doubtful(const Problem& problem, const Answer& answer) {
  const std::int32_t window = energyOf(answer.fit.signal);
  const std::int32_t noise = problem.noise(kUnexplained);
  return !answer.admissible || std::abs(answer.fit.offset) > kFarFromMiddle ||
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
    if (scan.energy() > best.energy()) best = scan;
  }
  solveWindow(problem, best, contest);
}

/// Where the model's strongest response has no single peak over the contact, every window is looked at.
void solveEverywhere(const Problem& problem, Contest& contest) {
  std::array<std::int32_t, kMaxGauges> energies{};
  std::int32_t largest = 0;
  for (int gauge = 0; gauge < problem.gauges(); ++gauge) {
    energies[static_cast<std::size_t>(gauge)] = scanWindow(problem, gauge).energy();
    largest = std::max(largest, energies[static_cast<std::size_t>(gauge)]);
  }
  const std::int32_t limit = largest - (largest >> kRivalShift) - problem.noise(kRivalMargin);
  for (int gauge = 0; gauge < problem.gauges(); ++gauge) {
    if (energies[static_cast<std::size_t>(gauge)] >= limit)
      solveWindow(problem, scanWindow(problem, gauge), contest);
  }
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
  fit.ambiguous = contest.second.found && contest.second.admissible &&
                  contest.second.energy > best.energy - problem.noise(kAmbiguous);
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
  Contest contest;
  if (tables.constants.anchor_rule == AnchorRule::kExhaustive) {
    solveEverywhere(problem, contest);
  } else {
    const int anchor = bendAnchor(problem);
    solveWindow(problem, scanWindow(problem, anchor), contest);
    if (doubtful(problem, contest.best)) solveBestOf(problem, anchor, std::array{-3, -2, 2, 3}, contest);
  }
  return reportOf(problem, contest);
}

}  // namespace strainfinger::firmware
