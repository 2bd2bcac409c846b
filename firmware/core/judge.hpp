#pragma once
// Which hypothesis is believed, and by which thresholds.

#include <cstdint>

#include "firmware/core/fit.hpp"

namespace strainfinger::firmware {

/// Chi-squared is the sum of squared weighted residuals over the variance of a gauge that reads nothing
/// (noise, rounding, model error); a difference of it is twice that of the log-likelihood.
namespace threshold {

/// A hypothesis is within the gate, so that it explains the readings, up to chi-squared = kGatePerFreedom *
/// freedoms + kGate: 4.8 standard normal deviates for 12 degrees of freedom (Wilson & Hilferty 1931).
inline constexpr int kGatePerFreedom = 2;
inline constexpr int kGate = 28;
/// Above chi-squared = kDoubtPerFreedom_q2 / 4 * freedoms + kDoubt an answer leaves doubt, even if accepted,
/// and other hypotheses are looked at as well: one touch in 250 by noise alone, for 12 degrees of freedom.
inline constexpr int kDoubtPerFreedom_q2 = 7;
inline constexpr int kDoubt = 8;
/// The same limit for a finger as built: the model error's part of the variance counts kAsBuilt times. Once a
/// search has looked into an answer it counts kStillAsBuilt times: with only one limit noise would begin
/// search after search. The limit is never beyond the gate.
inline constexpr int kAsBuilt = 2;
inline constexpr int kStillAsBuilt = 3;
/// What a second contact, or leaving out a gauge, must take off chi-squared to be believed. A second contact
/// has four more unknowns and the best of hundreds of places; leaving one out, the best of sixteen gauges.
inline constexpr int kSecondContact = 28;
inline constexpr int kLeftOut = 16;
/// [log2] Each reading may also be off by this part of the largest one, because the real pressure has another
/// profile than the tables': uniform pressures read as semi-ellipses, partial slip as a wider ellipse.
inline constexpr int kProfileErrorBits = 9;
/// An answer that is followed is given up only if it leaves kLost times kGate: hysteresis.
inline constexpr int kLost = 4;
/// Two answers are not told apart if their chi-squared differs by less than this. Of one set, the wrong one
/// of two is then reported without a flag at most once in 11,000, however far apart they are.
inline constexpr int kAmbiguous = 14;
/// A sample set refutes the rival (the second best answer) if the rival leaves more than the answer by
/// kRefuted times what ambiguity() allows.
inline constexpr int kRefuted = 4;
/// A search for one contact does not refine candidates that leave, after their first steps, 2^this times the
/// sum of what the best one leaves and kRefuted * kAmbiguous. Without this limit searches take longer: 4 %
/// more of the disturbed touches of host/bench are flagged, and as many as with it are wrong without a flag.
inline constexpr int kHopelessBits = 2;
/// Answers this many sixteenths of a pitch apart are at different places; nearer ones differ in width only.
inline constexpr int kElsewhere_16 = 4;
/// A rival that is nearly as likely is named and flagged if it is this many sixteenths of a pitch away or
/// more; if nearer, only where noise alone may have favoured the wrong one, else the errors cover it.
inline constexpr int kNamed_16 = 6;
/// A second initial guess is this many sixteenths of a pitch away: the coarse grid's next point but one.
inline constexpr int kOtherStart_16 = 6;
/// [log2] A touch whose second moment has changed by more than this part of the largest while it was followed
/// has been followed to another answer.
inline constexpr int kOtherWidthBits = 2;
/// Up to this model error [2^-16; 1 %] others are then looked for at once. Of 441,000 frames of 300 fast
/// slides on a finger of 60 mm, 97 were off by more than six of their errors without that, with it none: so
/// fewer than 1 % of such slides have any, with 95 % confidence (SlidingTest). Beyond it the errors cover
/// both answers, and touches of fingers as built would be flagged more often (5.4 % of those 4 mm wide, for 4
/// %: bench_matrix).
inline constexpr std::int32_t kWellKnown_q16 = 655;
/// What an inadmissible answer must take off chi-squared beyond an admissible one to be preferred. It is not
/// ruled out, because noise may have moved it beyond the friction cone.
inline constexpr int kInadmissible = 28;
/// From this ratio of the largest reading to a standard deviation on [squared], and up to this second moment,
/// a contact has no second answer near by: the gap of chi-squared is 80 at 14 N/m and 2 mm on the default
/// finger without model error. The deviation is that of the gauges that tell answers apart, which read a
/// quarter of the largest reading: with a model error of 0.4 % or more no touch is firm.
inline constexpr int kFirmSignal = 1'200'000;
inline constexpr int kFirmMoment_um2 = 360'000;
/// Below this ratio of a contact's largest reading to the noise's standard deviation [squared] its place is
/// not sure, as a second contact or a failed gauge would not show, nor on which side of a gauge it is. These
/// 95 deviations are 1.2 N/m on the default finger. Of 24,000 touches of 0.5 to 2 N/m, perfect and as built
/// (`bench_matrix --only "0.5 to 2" --touches 4000`), 1 is wrong without a flag with them, 18 were with 60.
inline constexpr int kWeakSignal = 9000;
/// A contact that was weak stays so up to here: its flag does not come and go with the noise of each set.
inline constexpr int kNoLongerWeakSignal = 10'000;
/// A contact of a pair is none if its largest reading squared is below this many of a reading's variances.
inline constexpr int kFaint = 36;
/// A pair is flagged if one of its normal loads is less than this many of its standard errors.
inline constexpr int kFewestSigmas = 5;
/// Two contacts this many sixteenths of a pitch apart are told apart; nearer ones are flagged.
inline constexpr int kApart_16 = 37;
/// A gauge is a suspect only if leaving out any other one takes at least this much less off chi-squared.
inline constexpr int kCulpritMargin = 12;
/// A suspect's reading is off by at least this: a 16th of 2^15, below which readings are scaled. Of the
/// largest reading it is a 16th to a quarter.
inline constexpr Number kCulprit = 1 << 11;
/// What a gauge reads speaks for or against it if it should read at least this, also a 16th of 2^15.
inline constexpr Number kFelt = 1 << 11;

}  // namespace threshold

/// The residual energy that stands for this chi-squared.
constexpr Wide energyOf(std::uint32_t variance_q4, Wide chiSquared) {
  return (chiSquared * variance_q4) >> 4;
}
constexpr Wide energyOf(const Variances& variances, Wide chiSquared) {
  return energyOf(variances.reading_q4, chiSquared);
}
constexpr Wide energyOf(const ScaledReadings& readings, Wide chiSquared) {
  return energyOf(readings.variances, chiSquared);
}

/// Two answers are not told apart if the residual energy of the worse one is higher by less than this, in the
/// mean of this many sets: noise averages out, the model error does not.
Wide ambiguity(const Variances& variances, int sets = 1);

/// A reading at a rail is only a bound: it is plausible if at least three quarters of it are predicted.
constexpr bool isRailPlausible(std::int32_t measured, std::int32_t predicted) {
  const std::int32_t least = measured - measured / 4;
  return measured < 0 ? predicted <= least : predicted >= least;
}

/// The contact presses and stays within the friction cone.
bool isAdmissible(const TableConstants& constants, const ContactState& contact);
bool isAdmissible(const TableConstants& constants, const Solution& solution);

/// A contact is felt by so little more than noise that its place is not sure; `was`: it was weak before.
bool isWeak(const Solution& solution, const Variances& variances, bool was);

/// The contact is as wide as the tables go: it may be wider, and where it is then is not known.
inline bool isWidest(const ContactState& contact) {
  return contact.moment_q20 > (1 << kMomentBits) - (1 << (kMomentBits - 6));
}

/// Two contacts nearer than they can be told apart.
bool areTooNear(const TableConstants& constants, const Solution& solution);

/// A fit from these contacts may lead to admissible ones. Away from the right place loads are far off, so
/// that four times the friction cone is allowed.
bool isPromising(const TableConstants& constants, const Solution& solution);

/// Residual energy, with threshold::kInadmissible added where the solution is not admissible.
Wide likelihoodEnergy(const TableConstants& constants, const Solution& solution,
                      const ScaledReadings& readings);

/// Degrees of freedom that are left.
int freedoms(const Hypothesis& hypothesis);

/// The hypothesis explains the readings within noise and model error, admissible or not.
bool isWithinGate(const Solution& solution, const ScaledReadings& readings);

/// isWithinGate(), and all contacts are admissible.
bool isAccepted(const TableConstants& constants, const Solution& solution, const ScaledReadings& readings);

/// Admissible, and within the limit of doubt, which noise alone seldom exceeds.
bool isPlain(const TableConstants& constants, const Solution& solution, const ScaledReadings& readings);

/// isAccepted(), and within the limit of doubt as on a finger as built (threshold::kAsBuilt). After gauges
/// were left out, two contacts need not be looked for if this holds. `was`: a search has looked into the
/// answer (threshold::kStillAsBuilt).
bool isPlainAsBuilt(const TableConstants& constants, const Solution& solution, const ScaledReadings& readings,
                    bool was = false);

/// So much signal and so narrow a contact, read by all gauges of a dense ring, that no other answer explains
/// the readings.
bool isFirm(const TableConstants& constants, const Solution& solution, const ScaledReadings& readings);

}  // namespace strainfinger::firmware
