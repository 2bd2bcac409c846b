#include "firmware/core/pipeline.hpp"

#include <algorithm>
#include <bit>

namespace strainfinger::firmware {
namespace {

/// Too few gauges work if more than one in eight is out of use.
constexpr int kGaugesPerOut = 8;
/// Readings up to kDisturbance standard deviations are a touch only if contacts explain kSettled sets in a
/// row, a bit more than a period of 50 Hz hum at 1 kHz: else they are a disturbance.
constexpr Wide kDisturbance = 64;
constexpr int kSettled = 24;
/// A disturbance whose readings are all within so many standard deviations may be drift, which zeros follow:
/// that of 2 microstrain a second during a touch of 5 s. Larger ones may be a touch that is too wide to be
/// told.
constexpr Wide kDrift = 6;

/// The gauges at a rail of which the answer tells whether they should be there. It doesn't tell if a load is
/// at the fit's limit, because the touch may make gauges read far more than is predicted, nor of gauges at
/// rails side by side, because the others don't tell what is between them.
GaugeSet judgedAtRail(const TableConstants& constants, const Solution& answer, GaugeSet atRail) {
  const auto contacts = answer.contacts();
  if (constants.spacing == RingSpacing::kSparse || std::any_of(contacts.begin(), contacts.end(), isLimited))
    return 0;
  return atRail & ~neighboursOf(atRail, constants.gauge_count);
}

}  // namespace

void Pipeline::takeZero(const ZeroAverage& zero) {
  zero.writeTo(calibration_);
  // These are open or shorted; with such a zero they would seem to read nothing.
  watch_.takeOut(zero.gaugesAtRail(constants()));
  noteOutOfUse();
}

void Pipeline::noteOutOfUse() {
  const GaugeSet outOfUse = this->outOfUse();
  observation_.outOfUse = outOfUse;
  observation_.tooFewGauges =
      outOfUse != 0 && std::popcount(outOfUse) * kGaugesPerOut > constants().gauge_count;
}

/// Small readings are a disturbance (hum or drift) until contacts explain kSettled sets in a row. A touch
/// stays one until contacts fail to explain as many: one reading that is off in one set doesn't end it.
bool Pipeline::isDisturbance(GaugeSet gauges) {
  const bool accepted = locator_.answer().accepted;
  if (isTouch_ && accepted) {
    contrarySets_ = 0;
    return false;
  }
  const Number noise = readingNoise_q32(constants());
  const Number largest = largestOf(strains(), gauges);
  const bool isStrong = largest > kDisturbance * noise;
  mayBeDrift_ = largest <= kDrift * noise;
  contrarySets_ = isStrong || accepted == isTouch_ ? 0 : static_cast<std::uint8_t>(contrarySets_ + 1);
  if (isStrong || contrarySets_ == kSettled) {
    isTouch_ = isStrong || accepted;
    contrarySets_ = 0;
  }
  return !isTouch_;
}

void Pipeline::locate(GaugeSet gauges) {
  const Number beyond_q32 = largestOf(strains(), observation_.saturated & ~outOfUse());
  locator_.update(*tables_, strains(), gauges, noise_.variance_q4(), beyond_q32);
  observation_.touched = !isDisturbance(gauges);
  const Answer& answer = locator_.answer();
  observation_.leftOut = allGauges(constants().gauge_count) & ~answer.solution.hypothesis.gauges;
  observation_.several = answer.several || answer.solution.hypothesis.contacts > 1;
}

/// Passes on what the answer says of each gauge. A suspect counts only in sets in which its own reading is
/// off, because it may have been wrong for a moment only.
void Pipeline::watchGauges() {
  const Answer& answer = locator_.answer();
  if (!answer.accepted || answer.searching) return;
  const Linearisation& fit = locator_.linearisation();
  GaugeSet atRail = 0, right = 0, wrong = 0, suspect = 0;
  const GaugeSet looked = watch_.watched() | answer.suspect | observation_.saturated;
  for (GaugeSet left = looked; left != 0; left &= left - 1) {
    const GaugeSet gauge = left & (0 - left);
    const auto i = index(std::countr_zero(left));
    const std::int32_t predicted = fit.predicted[i];
    const std::int32_t measured = readings_.strain_q32[i] >> answer.shift;
    if ((observation_.saturated & gauge) != 0) {
      if (!isRailPlausible(measured, predicted)) atRail |= gauge;
      continue;
    }
    const std::int32_t off = magnitude(measured - predicted);
    if (off >= threshold::kCulprit) suspect |= answer.suspect & gauge;
    if (magnitude(predicted) >= threshold::kFelt) (off <= magnitude(predicted) / 4 ? right : wrong) |= gauge;
  }
  if (atRail != 0) atRail &= judgedAtRail(constants(), answer.solution, observation_.saturated);
  if (watch_.implausiblyAtRail(atRail)) tracker_.beginAnew();
  watch_.suspect(suspect, answer.solution.contact[0].angle_q32);
  watch_.vindicate(right & ~suspect, wrong | atRail);
}

/// The codes are those of the last set of a touch, and the answer to them is found.
bool Pipeline::isKnown(Codes codes) const {
  if (!locator_.isSettled()) return false;
  if (observation_.saturated != 0) return false;  // a second set may take a gauge at a rail out of use
  return !areZerosNew_ && std::equal(codes.begin(), codes.end(), codes_.begin());
}

const Observation& Pipeline::process(Codes codes) {
  const bool wasSearching = locator_.isSearching();  // the set that concludes a search costs much, too
  if (observation_.touched && isKnown(codes)) {
    observation_.unchanged = true;
  } else {
    observe(codes);
  }
  if (observation_.touched) {
    noise_.interrupt();
  } else {
    noise_.take(constants(), strains(), ~(observation_.saturated | watch_.outOfUse()), contrarySets_ != 0);
  }
  noteOutOfUse();
  // The zero of a noisy gauge goes on following while nothing touches, as the gauge counts again once calm.
  const GaugeSet unfollowed = observation_.touched ? observation_.outOfUse : watch_.outOfUse();
  const bool isDisturbed = !observation_.touched && gate_.touched();
  const bool mayBeTouch = isDisturbed && !mayBeDrift_;
  tracker_.age();
  areZerosNew_ =
      !mayBeTouch && tracker_.take(*tables_, strains(), observation_.touched ? &locator_ : nullptr,
                                   observation_.leftOut | observation_.saturated | unfollowed, calibration_,
                                   locator_.scratch(), !wasSearching && !isDisturbed);
  if (areZerosNew_) watch_.noLongerAtRail(tracker_.calm());
  observation_.staleZero = tracker_.stale();
  observation_.noisy = noise_.isNoisy();
  return observation_;
}

bool Pipeline::isTouchedDuring(const ZeroAverage& zero) const {
  const Readings change = zero.change(calibration_);
  const std::uint32_t energy = gateEnergy(constants(), change.strains(constants().gauge_count), ~outOfUse());
  return ContactGate().update(constants(), energy, noise_.variance_q4());
}

void Pipeline::observe(Codes codes) {
  condition(calibration_, codes, readings_);
  const bool wasTouched = observation_.touched, wasOverGate = gate_.touched();
  observation_ = {};
  const GaugeSet working = allGauges(constants().gauge_count) & ~outOfUse();
  GaugeSet gauges = working;
  std::uint32_t energy = gateEnergy(constants(), strains());
  const bool mayBeTouched = energy >= constants().gate_off;
  if (mayBeTouched) {
    observation_.saturated = saturatedGauges(constants(), codes);
    gauges &= ~observation_.saturated;
    if (gauges != allGauges(constants().gauge_count)) energy = gateEnergy(constants(), strains(), gauges);
  }
  if (mayBeTouched && gate_.update(constants(), energy, noise_.variance_q4())) {
    locate(gauges);
    if (!observation_.touched) return;
    watchGauges();
    std::copy(codes.begin(), codes.end(), codes_.begin());
  } else {
    gate_ = {};
    if (watch_.implausiblyAtRail(observation_.saturated & working)) tracker_.beginAnew();
    isTouch_ = false;
    contrarySets_ = 0;
    if (wasOverGate) {
      wasTouched ? locator_.endTouch() : locator_.release();
    } else if (locator_.isSearching()) {  // a touch that ended may speak against a gauge
      if (const auto suspect = locator_.lookBack(*tables_))
        watch_.suspect(suspect->gauge, suspect->angle_q32);
    }
  }
}

}  // namespace strainfinger::firmware
