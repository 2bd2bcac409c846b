#include "firmware/core/gauge_watch.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

namespace strainfinger::firmware {
namespace {

constexpr std::uint32_t kNoise = 64;  ///< variances of a reading that noise alone doesn't leave
constexpr int kGainShift = 8;         ///< gains that are 6 % off leave this part of the energy
constexpr int kMayShift = 3;  ///< not worth a look: so much more than a contact leaves outside its window
constexpr int kNeighbourShift =
    3;                        ///< a contact over a gauge leaves more than this part of it in its neighbours
constexpr int kOwnShift = 4;  ///< a contact leaves more than this part of itself in other gauges than one

constexpr std::uint32_t kTold = 12;  ///< two culprits closer than this are not told apart

constexpr std::uint8_t kAccusation = 16;
constexpr std::uint8_t kConviction = 28;

constexpr std::uint8_t kExamineAtOnce = 4;  ///< so many misfits in a row ..
constexpr std::uint8_t kExamineEvery = 64;  ///< .. and then one in so many

constexpr int kLooksPerPitch = 16;

Split splitAt(const Problem& problem, int centre) {
  Split split;
  for (int step = -problem.gauges() / 2; step < problem.gauges() / 2; ++step) {
    const auto gauge = static_cast<std::size_t>(wrapped(centre + step, problem.gauges()));
    const std::int32_t energy = energyOf(scaledStrain(problem.strains[gauge], problem.up));
    std::abs(step) <= kWindowReach ? split.addInside(energy) : split.addOutside(energy);
  }
  return split;
}

std::int32_t tolerated(const Problem& problem) {
  return noiseAndPart(problem.variances(kNoise), problem.ringEnergy, kGainShift);
}

/// The gauge that can be left out with most effect, and what is then unexplained; wherever the contact is.
struct Suspect {
  enum class Kind : std::uint8_t { kFault, kMisshapen, kContact };  ///< a contact's: wide; another one
  std::int32_t unexplained = std::numeric_limits<std::int32_t>::max();
  std::int16_t look = 0;
  std::int8_t gauge = -1;
  Kind kind = Kind::kFault;
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

void lookThere(const Problem& problem, const RingSignal& signal, int look, Suspects& suspects) {
  const View view = lookAt(problem, wrapped(look, kLooksPerPitch * problem.gauges()));
  const LocalFit fit = localFit(problem, signal, view);
  if (!fit.share.determined) return;
  const std::int32_t outer = fit.share.outerEnergy();
  std::int32_t window = outer;
  for (int step = -kWindowReach; step <= kWindowReach; ++step)
    window += energyOf(signal.at(gaugeAt(problem, view, step)));
  const std::int32_t outside = std::max<std::int32_t>(problem.ringEnergy - window, 0);
  for (int step = -problem.gauges() / 2; step < problem.gauges() / 2; ++step) {
    const int gauge = gaugeAt(problem, view, step);
    if (contains(signal.leftOut, gauge)) continue;
    const std::int32_t reading = signal.at(gauge);
    Unexplained without{fit.share.unexplained, outside, window};
    if (std::abs(step) <= kWindowReach) {
      const std::int32_t residual = reading - fit.predicted(problem, view, step);
      without.leaveInside(reading, leftOut(reading, residual, fit.leverage_q15(step)));
    } else {
      without.leaveOutside(energyOf(reading));
    }
    if (std::abs(step) == kOuterReach && outer != 0)  // what the other one of the pair reads goes with it
      without.leaveOuter(outer, leftOut(0, fit.outerResidual(), fit.leverage_q15(kOuterReach)));
    const std::int32_t unexplained = without.energy(problem.tail_q16());
    enter(suspects, {unexplained, static_cast<std::int16_t>(look), static_cast<std::int8_t>(gauge)});
  }
}

/// Whether a contact of this window, with one gauge left out, can explain the ring at all.
bool mayExplain(const Problem& problem, int centre) {
  return splitAt(problem, centre).leastUnexplained(kMayShift) <= tolerated(problem);
}

/// What was observed, not yet as a problem: functions that make one of it don't share their stack.
struct Observed {
  const TableImage& tables;
  GaugeSet leftOut;
  std::span<const std::int32_t> strains_q32;
  std::uint32_t energy;

  Problem problem() const { return problemOf(tables, strains_q32, energy); }
};

/// How a suspect's reading compares with the contact that the others show: inside the window it is far off
/// what that one predicts; outside, it leaves its neighbours alone, as another contact would not.
[[gnu::noinline]] Suspect::Kind kindOf(const Problem& others, const RingSignal& signal, PitchQ20 position,
                                       int gauge, std::int32_t reading) {
  const View view = viewOf(others, position);
  const LocalFit fit = localFit(others, signal, view);
  std::int32_t outside = others.ringEnergy;
  const int reach = fitReach(others.gauges());
  for (int step = -reach; step <= reach; ++step) {
    const int each = gaugeAt(others, view, step);
    if (std::abs(step) <= kWindowReach) outside -= energyOf(signal.at(each));
    if (each != gauge) continue;
    const std::int32_t expected = scaledStrain(fit.expected_q32(others, signal, view, step), others.up);
    return farOff(reading, expected) > 0 ? Suspect::Kind::kFault : Suspect::Kind::kMisshapen;
  }
  const bool alone =
      outside <= noiseAndPart(others.variances(kNoise / 2), energyOf(reading), kNeighbourShift);
  return alone ? Suspect::Kind::kFault : Suspect::Kind::kContact;
}

/// The best contact about a look.
[[gnu::noinline]] Candidate bestNear(const Problem& others, const RingSignal& signal, int look) {
  Candidate best;
  const int looks = kLooksPerPitch * others.gauges();
  for (int near = look - 2; near <= look + 2; near += 2) {
    const Candidate candidate = followed(others, signal, lookAt(others, wrapped(near, looks)));
    if (candidate.admissible && candidate.explained > best.explained) best = candidate;
  }
  return best;
}

/// Looks at a suspect closely: what one contact leaves unexplained of the ring without it, and whether it is
/// far off what that contact says.
[[gnu::noinline]] void examine(const Observed& observed, Suspect& suspect) {
  Problem others = observed.problem();
  const auto reading = scaledStrain(others.strains[static_cast<std::size_t>(suspect.gauge)], others.up);
  others.ringEnergy = std::max<std::int32_t>(others.ringEnergy - energyOf(reading), 1);
  const RingSignal signal{others, observed.leftOut | 1u << suspect.gauge};
  Candidate best = bestNear(others, signal, suspect.look);
  if (!best.admissible) best = searchRemaining(others, signal).best;
  suspect.unexplained = leftOf(others.ringEnergy, best.explained);
  suspect.kind = kindOf(others, signal, best.place.position, suspect.gauge, reading);
}

/// A contact always moves two gauges: one alone is a fault.
[[gnu::noinline]] int loneGauge(const Observed& observed) {
  const Problem problem = observed.problem();
  const RingSignal signal{problem, observed.leftOut};
  int largest = 0;
  for (int gauge = 1; gauge < problem.gauges(); ++gauge)
    if (std::abs(signal.at(gauge)) > std::abs(signal.at(largest))) largest = gauge;
  const std::int32_t others = problem.ringEnergy - energyOf(signal.at(largest));
  const bool alone =
      others <= noiseAndPart(problem.variances(kNoise / 2), problem.ringEnergy, kGainShift - 1);
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

/// What one contact leaves unexplained of the ring with all its gauges.
[[gnu::noinline]] std::int32_t unexplainedWithAll(const Observed& observed) {
  const Problem problem = observed.problem();
  const RingSignal signal{problem, observed.leftOut};
  return problem.ringEnergy - std::max<std::int32_t>(searchRemaining(problem, signal).best.explained, 0);
}

/// One contact's fit takes their difference: without either it is the same fit, which can't tell them apart.
bool areOuterPair(const Suspect& a, const Suspect& b, int gauges) {
  const int apart = std::abs(a.gauge - b.gauge);
  return hasOuterPair(gauges) && std::min(apart, gauges - apart) == 2 * kOuterReach;
}

/// `all`: unexplainedWithAll().
[[gnu::noinline]] Misfit verdictOn(const Observed& observed, const Suspects& suspects, std::int32_t all) {
  const Suspect& best = suspects[0];
  const Problem problem = observed.problem();
  if (best.unexplained > noiseAndPart(problem.variances(kNoise / 2), all, kOwnShift))
    return {.several = true};
  const std::int32_t clear = mostLikeIt(best.unexplained, problem.variances(kTold));
  if (best.unexplained > tolerated(problem) / 2) return {.several = true};
  if (suspects[1].unexplained <= clear) {
    const bool pair = areOuterPair(best, suspects[1], problem.gauges()) && suspects[2].unexplained > clear;
    return {.several = !pair};
  }
  if (best.kind == Suspect::Kind::kContact) return {.several = true};
  return {.culprit = best.kind == Suspect::Kind::kFault ? 1u << best.gauge : 0};
}

}  // namespace

bool isMisfit(const TableImage& tables, std::span<const std::int32_t> strains_q32, std::uint32_t energy,
              const Fit& fit) {
  const Problem problem = problemOf(tables, strains_q32, energy);
  const std::int32_t outside =
      excessOutside(problem.ringEnergy - fit.windowEnergy, fit.windowEnergy, problem.tail_q16());
  return fit.unexplained + outside > tolerated(problem);
}

Misfit examine(const TableImage& tables, GaugeSet leftOut, std::span<const std::int32_t> strains_q32,
               std::uint32_t energy) {
  const Observed observed{tables, leftOut, strains_q32, energy};
  if (const int lone = loneGauge(observed); lone >= 0) return {.culprit = 1u << lone};
  Suspects suspects;
  lookEverywhere(observed, suspects);
  for (Suspect& suspect : suspects)
    if (suspect.gauge >= 0) examine(observed, suspect);
  sort(suspects);
  return verdictOn(observed, suspects, unexplainedWithAll(observed));
}

bool JumpWatch::isOthersNoise(const TableConstants& constants, std::int32_t reading,
                              std::uint32_t energy) const {
  const auto isQuietWithout = [&](std::int32_t own, std::uint32_t all) {
    return std::int64_t{all} - gatePart(own, constants.gate_shift) < constants.gate_off;
  };
  return isQuietWithout(reading, energy) && isQuietWithout(before_q32_, energyBefore_);
}

void GaugeWatch::count(GaugeSet culprits) {
  anyScore_ = false;
  for (std::size_t i = 0; i < score_.size(); ++i) {
    if (contains(outOfUse_, static_cast<int>(i))) continue;
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

void GaugeWatch::reconsider(GaugeSet right, GaugeSet wrong) {
  for (std::size_t i = 0; i < score_.size(); ++i) {
    const GaugeSet gauge = 1u << i;
    if ((wrong & gauge) != 0) score_[i] = 0;
    if ((right & gauge & ~beyondDoubt_) == 0 || ++score_[i] < kConvincing) continue;
    outOfUse_ &= ~gauge;
    score_[i] = 0;
  }
}

bool GaugeWatch::wantsToExamine() {
  if (misfits_ + 1 < kExamineAtOnce + kExamineEvery) {
    ++misfits_;
  } else {
    misfits_ = kExamineAtOnce;
  }
  return misfits_ <= kExamineAtOnce;
}

}  // namespace strainfinger::firmware
