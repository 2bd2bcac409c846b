#pragma once
// Which hypothesis is believed, and by which thresholds.

#include <cstdint>

#include "firmware/core/fit.hpp"

namespace strainfinger::firmware {

/// Thresholds. Chi-squared is the sum of squared weighted residuals over the variance of a gauge that reads
/// nothing (noise, rounding, model error); differences of it are twice those of the log-likelihood.
namespace threshold {

/// A hypothesis explains the readings up to chi-squared = kGatePerFreedom * freedoms + kGate: 5.0 standard
/// normal deviates for 12 degrees of freedom (Wilson & Hilferty 1931).
inline constexpr int kGatePerFreedom = 2;
inline constexpr int kGate = 28;
/// Above kDoubtPerFreedom_q2 / 4 * freedoms + kDoubt the other hypotheses are looked at as well, although
/// this one is accepted: one touch in 250 by noise alone, for 12 degrees of freedom.
inline constexpr int kDoubtPerFreedom_q2 = 7;
inline constexpr int kDoubt = 8;
/// On a finger as built an answer leaves no doubt within that limit of chi-squared with the model's part of
/// the variance times kAsBuilt. Once a search has looked into it, times kStillAsBuilt: at one and the same
/// limit noise would begin search after search. Never beyond the gate.
inline constexpr int kAsBuilt = 2;
inline constexpr int kStillAsBuilt = 3;
/// What a second contact, or a gauge that is left out, must take off chi-squared to be believed: four more
/// unknowns at the best of hundreds of places; one of sixteen gauges.
inline constexpr int kSecondContact = 28;
inline constexpr int kLeftOut = 16;
/// What no pressure profile of the tables has: part of the largest reading, as a power of two, by which each
/// reading may be off besides [log2]. Uniform pressures read as semi-ellipses, partial slip as a wider
/// ellipse.
inline constexpr int kProfileErrorBits = 9;
/// An answer that was followed is given up where it leaves so many times kGate: hysteresis.
inline constexpr int kLost = 4;
/// Two answers are not told apart within so many variances of a reading: of one set, the wrong one of two is
/// told unflagged at most once in 11,000, however far apart they are.
inline constexpr int kAmbiguous = 14;
/// A second answer is refuted by a sample set of which it leaves so many times more than would be ambiguous.
inline constexpr int kRefuted = 4;
/// Of one contact, a search does not refine candidates which leave, after their first steps, so many times
/// [log2] what the best one leaves and kRefuted * kAmbiguous. Without that limit searches take longer: 4 %
/// more of the disturbed touches of host/bench are flagged, and as many are silently wrong.
inline constexpr int kHopelessBits = 2;
/// Answers so many sixteenths of a pitch apart are at different places, rather than of different widths.
inline constexpr int kElsewhere_16 = 4;
/// A second answer so many sixteenths of a pitch away, or farther, is named and flagged; a nearer one only if
/// noise alone may have told the wrong one, else it is enough that errors reach it.
inline constexpr int kNamed_16 = 6;
/// A second start is so many sixteenths of a pitch away from the first: the coarse grid's next point but one.
inline constexpr int kOtherStart_16 = 6;
/// A touch does not change its second moment by more than this part of the largest [log2] while it is
/// followed: the fit went to another answer.
inline constexpr int kOtherWidthBits = 2;
/// An inadmissible answer is believed only if it explains so much more: noise may have moved it there.
inline constexpr int kInadmissible = 28;
/// Largest reading over a standard deviation [squared] and second moment of contacts that have no second
/// answer near by: the gap of chi-squared is 80 at 14 N/m and 2 mm on the default finger without model error.
/// The deviation is that of the gauges that tell answers apart, which read a quarter of the largest reading:
/// with a model error of 0.4 % or more no touch is firm.
inline constexpr int kFirmSignal = 1'200'000;
inline constexpr int kFirmMoment_um2 = 360'000;
/// A contact's largest reading over a standard deviation of noise [squared] below which its place is not
/// sure: a second contact or a gauge that failed does not show then. It is 0.77 N/m on the default finger.
/// With 40 deviations 0.17 % of touches of 0.5 N/m were silently wrong, with these 60 none of 4,000.
inline constexpr int kWeakSignal = 3600;
/// A weak contact stays one up to here, so that its flag does not come and go with the noise of each set.
inline constexpr int kNoLongerWeakSignal = 4000;
/// Each of two contacts must be felt by so many times kWeakSignal, or kNoLongerWeakSignal: 1.1 N/m on the
/// default finger. Of 73,125 pairs (`bench_matrix --only "two contacts" --seed N`, N 3001 to 3003) 24 end
/// silently wrong with it and 41 without; 1,123 more are flagged.
inline constexpr int kWeakOfTwo = 2;
/// A contact of a pair whose loads explain less than this much of chi-squared is none.
inline constexpr int kFaint = 36;
/// A contact of a pair is sure from so many of its load's standard errors on.
inline constexpr int kFewestSigmas = 5;
/// Two contacts are told apart from so many sixteenths of a pitch on; nearer ones are flagged.
inline constexpr int kApart_16 = 37;
/// A gauge is a suspect only if leaving it out takes this much more off chi-squared than any other gauge.
inline constexpr int kCulpritMargin = 12;
/// A suspect's reading is off by at least so much: a 16th of what readings are scaled to [scaled reading].
inline constexpr Number kCulprit = 1 << 11;
/// What a gauge reads speaks for or against it where it should read so much: an eighth of the largest
/// reading, or more [scaled reading].
inline constexpr Number kFelt = 1 << 11;

}  // namespace threshold

/// Sum of squares that is so much of chi-squared.
constexpr Wide energyOf(std::uint32_t variance_q4, Wide chiSquared) {
  return (chiSquared * variance_q4) >> 4;
}
constexpr Wide energyOf(const Variances& variances, Wide chiSquared) {
  return energyOf(variances.reading_q4, chiSquared);
}
constexpr Wide energyOf(const ScaledReadings& readings, Wide chiSquared) {
  return energyOf(readings.variances, chiSquared);
}

/// Two answers are not told apart where the worse one leaves less than so much more, in the mean of so many
/// sets: noise averages out, the model's error does not.
Wide ambiguity(const Variances& variances, int sets = 1);

/// A reading at a rail is a bound: what the contacts should make it read is as much or more, within a
/// quarter.
constexpr bool isRailPlausible(std::int32_t measured, std::int32_t predicted) {
  const std::int32_t least = measured - measured / 4;
  return measured < 0 ? predicted <= least : predicted >= least;
}

/// The contact presses and stays within the friction cone.
bool isAdmissible(const TableConstants& constants, const ContactState& contact);
bool isAdmissible(const TableConstants& constants, const Solution& solution);

/// A contact is felt by so little more than noise that its place is not sure; `was`: in the set before.
bool isWeak(const Solution& solution, const Variances& variances, bool was);

/// Two contacts nearer than they can be told apart.
bool areTooNear(const TableConstants& constants, const Solution& solution);

/// A fit from these contacts may lead to admissible ones: beside the right place loads are far off.
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

/// Admissible, and within what leaves no doubt: noise alone seldom leaves more.
bool isPlain(const TableConstants& constants, const Solution& solution, const ScaledReadings& readings);

/// isAccepted(), and within what leaves no doubt with the model's part of the variance times
/// threshold::kAsBuilt, as on a finger as built: that leaves no doubt once gauges were left out, and whether
/// there are two contacts need not be looked at. `was`: a search has looked into it.
bool isPlainAsBuilt(const TableConstants& constants, const Solution& solution, const ScaledReadings& readings,
                    bool was = false);

/// So much signal and so narrow a contact, read by all gauges of a dense ring, that no other answer explains
/// the readings.
bool isFirm(const TableConstants& constants, const Solution& solution, const ScaledReadings& readings);

}  // namespace strainfinger::firmware
