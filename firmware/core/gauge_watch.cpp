#include "firmware/core/gauge_watch.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

namespace strainfinger::firmware {
namespace {

constexpr std::uint32_t kNoise = 64;  ///< variances of a reading that noise alone doesn't leave
constexpr int kGainShift = 8;         ///< gains that are 6 % off leave this part of the energy
constexpr int kOutsideShift = 3;  ///< a contact leaves less than this part of its energy outside its window
constexpr int kOneOutsideShift = 5;  ///< .. and this in one gauge

constexpr std::uint32_t kTold = 12;  ///< two culprits closer than this are not told apart

constexpr std::uint8_t kAccusation = 16;
constexpr std::uint8_t kConviction = 28;

constexpr std::uint8_t kExamineAtOnce = 4;  ///< so many misfits in a row ..
constexpr std::uint8_t kExamineEvery = 64;  ///< .. and then one in so many

constexpr int kLooksPerPitch = 16;

std::int32_t energyOf(std::int32_t reading) { return (reading * reading) >> 2; }

/// Energies of a ring about a window, and the largest of each.
struct Split {
  std::int32_t window = 0, outside = 0;
  std::int32_t largestInside = 0, largestOutside = 0;
};

Split splitAt(const Problem& problem, int centre) {
  Split split;
  for (int step = -problem.gauges() / 2; step < problem.gauges() / 2; ++step) {
    const auto gauge = static_cast<std::size_t>(wrapped(centre + step, problem.gauges()));
    const std::int32_t energy = energyOf(scaledStrain(problem.strains[gauge], problem.shift));
    const bool inside = std::abs(step) <= kWindowReach;
    (inside ? split.window : split.outside) += energy;
    std::int32_t& largest = inside ? split.largestInside : split.largestOutside;
    largest = std::max(largest, energy);
  }
  return split;
}

std::int32_t tolerated(const Problem& problem) {
  return problem.noise(kNoise) + (problem.ringEnergy >> kGainShift);
}

/// The gauge that can be left out with most effect, and what is then unexplained; wherever the contact is.
struct Suspect {
  int gauge = -1;
  int look = 0;
  std::int32_t unexplained = std::numeric_limits<std::int32_t>::max();
};

using Suspects = std::array<Suspect, 4>;  ///< of different gauges, the best first

bool lessUnexplained(const Suspect& a, const Suspect& b) { return a.unexplained < b.unexplained; }

/// Into order; a few, and no stack for a sort of many.
void sort(Suspects& suspects) {
  for (std::size_t end = suspects.size() - 1; end > 0; --end)
    for (std::size_t i = 0; i < end; ++i)
      if (lessUnexplained(suspects[i + 1], suspects[i])) std::swap(suspects[i], suspects[i + 1]);
}

void enter(Suspects& suspects, const Suspect& suspect) {
  std::size_t known = 0;
  while (known + 1 < suspects.size() && suspects[known].gauge != suspect.gauge) ++known;
  if (!lessUnexplained(suspect, suspects[known])) return;
  suspects[known] = suspect;
  sort(suspects);
}

View lookAt(const Problem& problem, int look) {
  constexpr int kRows = kRowsPerPitch / kLooksPerPitch;
  return viewOf(problem, roundTheRing((2 * look + 1) * (kRows / 2) * kRowSpacing, problem.gauges()));
}

/// What leaving a gauge out takes off the unexplained energy: r^2 / (1 - h).
std::int32_t relief(std::int32_t residual, std::int32_t leverage_q15) {
  const std::int32_t left = std::max<std::int32_t>((1 << 15) - leverage_q15, 1 << 9);
  return saturate<std::int32_t>((std::int64_t{residual} * residual << 13) / left);
}

void lookThere(const Problem& problem, const RingSignal& signal, int look, Suspects& suspects) {
  const View view = lookAt(problem, wrapped(look, kLooksPerPitch * problem.gauges()));
  const LocalFit fit = localFit(problem, signal, view);
  if (!fit.share.determined) return;
  std::int32_t window = 0;
  for (int step = -kWindowReach; step <= kWindowReach; ++step)
    window += energyOf(signal.at(gaugeAt(problem, view, step)));
  const std::int32_t outside = std::max<std::int32_t>(problem.ringEnergy - window, 0);
  for (int step = -problem.gauges() / 2; step < problem.gauges() / 2; ++step) {
    const int gauge = gaugeAt(problem, view, step);
    if (contains(signal.leftOut, gauge)) continue;
    const std::int32_t reading = signal.at(gauge);
    std::int32_t inside = fit.share.unexplained, beyond = outside, trusted = window;
    if (std::abs(step) <= kWindowReach) {
      const std::int32_t residual = reading - fit.predicted(problem, view, step);
      inside -= relief(residual, fit.leverage_q15(step));
      trusted -= energyOf(reading);
    } else {
      beyond -= energyOf(reading);
    }
    const std::int32_t unexplained =
        std::max<std::int32_t>(inside, 0) + std::max<std::int32_t>(beyond - (trusted >> kOutsideShift), 0);
    enter(suspects, {gauge, look, unexplained});
  }
}

/// Whether a contact of this window, with one gauge left out, can explain the ring at all.
bool mayExplain(const Problem& problem, int centre) {
  const Split split = splitAt(problem, centre);
  const std::int32_t trusted = split.window - split.largestInside;
  return split.outside - split.largestOutside - (trusted >> kOutsideShift) <= tolerated(problem);
}

/// What was observed, not yet as a problem: functions that make one of it don't share their stack.
struct Observed {
  const TableImage& tables;
  GaugeSet leftOut;
  std::span<const std::int32_t> strains_q32;
  std::uint32_t energy;

  Problem problem() const { return problemOf(tables, FitMode::kRefined, strains_q32, energy); }
};

/// What one contact leaves unexplained of the ring without the suspect.
[[gnu::noinline]] std::int32_t unexplainedWithout(const Observed& observed, const Suspect& suspect) {
  Problem others = observed.problem();
  const auto reading = scaledStrain(others.strains[static_cast<std::size_t>(suspect.gauge)], others.shift);
  others.ringEnergy = std::max<std::int32_t>(others.ringEnergy - energyOf(reading), 1);
  const RingSignal signal{others, observed.leftOut | 1u << suspect.gauge};
  std::int32_t most = 0;
  for (int look = suspect.look - 2; look <= suspect.look + 2; look += 2) {
    const int looks = kLooksPerPitch * others.gauges();
    const Candidate candidate = followed(others, signal, lookAt(others, wrapped(look, looks)));
    if (candidate.admissible) most = std::max(most, candidate.explained);
  }
  if (most == 0) most = std::max<std::int32_t>(searchRemaining(others, signal).best.explained, 0);
  return std::max<std::int32_t>(others.ringEnergy - most, 0);
}

/// A contact always moves two gauges: one alone is a fault.
[[gnu::noinline]] int loneGauge(const Observed& observed) {
  const Problem problem = observed.problem();
  const RingSignal signal{problem, observed.leftOut};
  int largest = 0;
  for (int gauge = 1; gauge < problem.gauges(); ++gauge)
    if (std::abs(signal.at(gauge)) > std::abs(signal.at(largest))) largest = gauge;
  const std::int32_t others = problem.ringEnergy - energyOf(signal.at(largest));
  const bool alone = others <= problem.noise(kNoise / 2) + (problem.ringEnergy >> (kGainShift - 1));
  return alone ? largest : -1;
}

[[gnu::noinline]] void lookEverywhere(const Observed& observed, Suspects& suspects) {
  const Problem problem = observed.problem();
  const RingSignal signal{problem, observed.leftOut};
  for (int centre = 0; centre < problem.gauges(); ++centre) {
    if (!mayExplain(problem, centre)) continue;
    for (int look = -kLooksPerPitch / 2; look < kLooksPerPitch / 2; ++look)
      lookThere(problem, signal, kLooksPerPitch * centre + look, suspects);
  }
}

[[gnu::noinline]] Misfit verdictOn(const Observed& observed, const Suspects& suspects) {
  const Suspect& best = suspects[0];
  const Problem problem = observed.problem();
  const std::int32_t clear = best.unexplained + best.unexplained / 4 + problem.noise(kTold);
  if (best.unexplained <= tolerated(problem) / 2 && suspects[1].unexplained > clear)
    return {.culprit = 1u << best.gauge};
  return {.several = true};
}

}  // namespace

bool isMisfit(const TableImage& tables, std::span<const std::int32_t> strains_q32, std::uint32_t energy,
              const Fit& fit) {
  const Problem problem = problemOf(tables, FitMode::kRefined, strains_q32, energy);
  const Split split = splitAt(problem, fit.centre);
  const std::int32_t outside = std::max<std::int32_t>(split.outside - (split.window >> kOutsideShift), 0);
  return fit.unexplained + outside > tolerated(problem) ||
         split.largestOutside > problem.noise(kNoise) + (split.window >> kOneOutsideShift);
}

Misfit examine(const TableImage& tables, GaugeSet leftOut, std::span<const std::int32_t> strains_q32,
               std::uint32_t energy) {
  const Observed observed{tables, leftOut, strains_q32, energy};
  if (const int lone = loneGauge(observed); lone >= 0) return {.culprit = 1u << lone};
  Suspects suspects;
  lookEverywhere(observed, suspects);
  for (Suspect& suspect : suspects)
    if (suspect.gauge >= 0) suspect.unexplained = unexplainedWithout(observed, suspect);
  sort(suspects);
  return verdictOn(observed, suspects);
}

GaugeSet JumpWatch::take(std::span<const std::int32_t> strains_q32) {
  const std::int32_t reading = strains_q32[gauge_];
  if (looks_ == 0) {
    jumps_ = 0;
  } else if (std::abs(std::int64_t{reading} - before_q32_) > jump_q32_ && ++jumps_ == kJumps) {
    looks_ = 0;
    return 1u << gauge_;
  }
  before_q32_ = reading;
  if (++looks_ > kLooks) {
    looks_ = 0;
    gauge_ = gauge_ + 1u < strains_q32.size() ? static_cast<std::uint8_t>(gauge_ + 1) : std::uint8_t{0};
  }
  return 0;
}

void GaugeWatch::count(GaugeSet culprits) {
  anyScore_ = false;
  for (std::size_t i = 0; i < score_.size(); ++i) {
    std::uint8_t& score = score_[i];
    if (!contains(culprits, static_cast<int>(i))) {
      if (score > 0) --score;
    } else if ((score = static_cast<std::uint8_t>(score + kAccusation)) >= kConviction) {
      outOfUse_ |= 1u << i;
      score = 0;
    }
    anyScore_ |= score != 0;
  }
}

bool GaugeWatch::wantsToExamine() {
  if (misfits_ < kExamineAtOnce + kExamineEvery) {
    ++misfits_;
  } else {
    misfits_ = kExamineAtOnce;
  }
  return misfits_ <= kExamineAtOnce;
}

}  // namespace strainfinger::firmware
