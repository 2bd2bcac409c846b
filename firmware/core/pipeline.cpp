#include "firmware/core/pipeline.hpp"

namespace strainfinger::firmware {
namespace {

void clear(GaugeSet gauges, std::span<std::int32_t> strains_q32) {
  for (std::size_t i = 0; gauges != 0; ++i, gauges >>= 1)
    if ((gauges & 1) != 0) strains_q32[i] = 0;
}

/// Made where it will stay, and nowhere else: a fit more on the stack is too much.
template <typename Make>
struct Made {
  Make make;
  operator Fit() const { return make(); }
};
template <typename Make>
Made(Make) -> Made<Make>;

}  // namespace

/// In one place, and small: of readings that were changed.
[[gnu::noinline, gnu::cold]] std::uint32_t Pipeline::energyAgain() {
  return gateEnergy(constants(), strains());
}

/// Not inlined, nor are the other stages that need much stack: none needs the others'.
[[gnu::noinline]] void Pipeline::look() {
  observation_.fit.reset();
  if (!gate_.update(constants(), energy_)) return;
  if (observation_.leftOut == 0) {
    observation_.fit.emplace(Made{[&] { return locate(*tables_, mode_, strains(), energy_); }});
  } else {
    observation_.fit.emplace(
        Made{[&] { return locateWithout(*tables_, observation_.leftOut, strains(), energy_); }});
    energy_ = energyAgain();  // what was filled in is in the fit
  }
}

[[gnu::always_inline]] inline void Pipeline::lookWithout(GaugeSet gauges) {
  observation_.leftOut |= gauges;
  clear(observation_.leftOut, strains());
  energy_ = energyAgain();
  look();
}

/// Gauges at a rail where the others say that they should be well within their range.
[[gnu::cold]] GaugeSet Pipeline::implausiblySaturated(Codes codes) const {
  GaugeSet gauges = 0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if ((observation_.saturated >> i & 1) == 0) continue;
    const std::int32_t measured = strainOf(calibration_, codes[i], i), predicted = readings_.strain_q32[i];
    const std::int32_t least = leastAtRail(measured);
    const bool beyond = measured < 0 ? predicted < least : predicted > least;
    if (!beyond) gauges |= 1u << i;
  }
  return gauges;
}

/// Gauges out of use against what the others predict, where that is much.
[[gnu::noinline, gnu::cold]] void Pipeline::reconsider(Codes codes) {
  GaugeSet right = 0, wrong = 0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (!contains(watch_.outOfUse(), static_cast<int>(i))) continue;
    const std::int32_t predicted = readings_.strain_q32[i];
    if (muchOf(gatePart(predicted, constants().gate_shift)) < energy_) continue;
    (offBy(strainOf(calibration_, codes[i], i), predicted) < 0 ? right : wrong) |= 1u << i;
  }
  watch_.reconsider(right, wrong);
}

/// Gauges out of use that feel a firm touch while the ring is untouched: stuck, whatever the others feel of
/// the next one.
[[gnu::noinline, gnu::cold]] void Pipeline::convictStuck(Codes codes) {
  GaugeSet stuck = 0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (!contains(watch_.outOfUse(), static_cast<int>(i))) continue;
    const auto energy =
        static_cast<std::uint32_t>(gatePart(strainOf(calibration_, codes[i], i), constants().gate_shift));
    if (energy / 16 >= constants().gate_on) stuck |= 1u << i;
  }
  watch_.convict(stuck);
}

[[gnu::noinline]] GaugeSet Pipeline::culprits(Codes codes) {
  GaugeSet gauges = 0;
  if (observation_.saturated != 0) gauges = implausiblySaturated(codes);
  const bool misfit = observation_.fit && isMisfit(*tables_, strains(), energy_, *observation_.fit);
  if (!misfit) {
    watch_.allIsWell();
    if (watch_.outOfUse() != 0 && observation_.fit && observation_.fit->settled) reconsider(codes);
  } else if (watch_.wantsToExamine()) {
    clear(observation_.leftOut, strains());
    const Misfit found = examine(*tables_, observation_.leftOut, strains(), energyAgain());
    watch_.found(found);
    gauges |= found.culprit;
  }
  return gauges;
}

/// What the sample set teaches.
[[gnu::always_inline]] inline void Pipeline::conclude(GaugeSet accused) {
  watch_.accuse(accused);
  if (const GaugeSet noisy = jumps_.take(constants(), strains(), energy_); noisy != 0) watch_.convict(noisy);
  tracker_.take(*tables_, strains(), energy_, observation_.fit, observation_.leftOut, calibration_);
  observation_.staleZero = tracker_.stale();
  observation_.outOfUse = watch_.outOfUse();
  observation_.several = watch_.several();
}

void Pipeline::takeZero(const ZeroAverage& zero) {
  zero.writeTo(calibration_);
  tracker_.restart();
  watch_ = {};
}

const Observation& Pipeline::process(Codes codes) {
  condition(calibration_, codes, readings_);
  energy_ = gateEnergy(constants(), strains());
  // What is at a rail and yet no touch does no harm.
  observation_.saturated = gate_.passes(constants(), energy_) ? saturatedGauges(constants(), codes) : 0;
  observation_.leftOut = 0;
  const GaugeSet known = watch_.outOfUse() | observation_.saturated;
  known != 0 ? lookWithout(known) : look();
  GaugeSet accused = 0;
  if (observation_.fit || observation_.saturated != 0) {
    accused = culprits(codes);
  } else {
    watch_.allIsWell();
    if (watch_.outOfUse() != 0) convictStuck(codes);
  }
  if ((accused & ~observation_.leftOut) != 0) lookWithout(accused);
  conclude(accused);
  return observation_;
}

}  // namespace strainfinger::firmware
