#include "firmware/core/judge.hpp"

#include <algorithm>
#include <bit>

namespace strainfinger::firmware {
namespace {

Number largestReading(const ScaledReadings& readings, GaugeSet gauges) {
  Number largest = 0;
  for (int i = 0; i < kMaxGauges; ++i)
    if (contains(gauges, i)) largest = larger(largest, magnitude(Number{readings.value[index(i)]}));
  return largest;
}

/// Allows in addition for the error of the tables' pressure profiles.
bool isWithin(const Solution& solution, const ScaledReadings& readings, Wide allowed) {
  const int left = freedoms(solution.hypothesis);
  if (left < 1) return false;
  if (solution.residualEnergy <= allowed) return true;
  const Number off = largestReading(readings, solution.hypothesis.gauges) >> 5;
  const Wide profile = (Wide{off} * off * left) >> (2 * (threshold::kProfileErrorBits - 5));
  return solution.residualEnergy <= allowed + profile;
}

int doubt(const Hypothesis& hypothesis) {
  return (threshold::kDoubtPerFreedom_q2 * freedoms(hypothesis) >> 2) + threshold::kDoubt;
}

}  // namespace

Wide ambiguity(const Variances& variances, int sets) {
  const Wide model_q4 = Wide{variances.reading_q4} - variances.noise_q4;
  return (threshold::kAmbiguous * (model_q4 + Wide{variances.noise_q4} / sets)) >> 4;
}

bool isAdmissible(const TableConstants& constants, const ContactState& contact) {
  return contact.normal > 0 && magnitude(contact.tangential) <= scaled<8>(contact.normal, constants.cone_q8);
}

bool isAdmissible(const TableConstants& constants, const Solution& solution) {
  for (const ContactState& contact : solution.contacts())
    if (!isAdmissible(constants, contact)) return false;
  return true;
}

bool isPromising(const TableConstants& constants, const Solution& solution) {
  for (const ContactState& contact : solution.contacts())
    if (contact.normal <= 0 ||
        magnitude(contact.tangential) >> 2 > scaled<8>(contact.normal, constants.cone_q8))
      return false;
  return true;
}

bool isWeak(const Solution& solution, const Variances& variances, bool was) {
  const Wide least =
      energyOf(variances.noise_q4, was ? threshold::kNoLongerWeakSignal : threshold::kWeakSignal);
  for (const ContactState& contact : solution.contacts()) {
    const Wide reading = contact.normal / 2;  // where it is felt most
    if (reading * reading < least) return true;
  }
  return false;
}

bool areTooNear(const TableConstants& constants, const Solution& solution) {
  if (solution.hypothesis.contacts < 2) return false;
  return apart_q32(solution.contact[0].angle_q32, solution.contact[1].angle_q32) <
         threshold::kApart_16 * (pitch_q32(constants) / 16);
}

Wide likelihoodEnergy(const TableConstants& constants, const Solution& solution,
                      const ScaledReadings& readings) {
  return solution.residualEnergy +
         (isAdmissible(constants, solution) ? 0 : energyOf(readings, threshold::kInadmissible));
}

int freedoms(const Hypothesis& hypothesis) {
  return std::popcount(hypothesis.gauges) - hypothesis.unknowns();
}

bool isWithinGate(const Solution& solution, const ScaledReadings& readings) {
  const int left = freedoms(solution.hypothesis);
  return isWithin(solution, readings,
                  energyOf(readings, threshold::kGatePerFreedom * left + threshold::kGate));
}

bool isAccepted(const TableConstants& constants, const Solution& solution, const ScaledReadings& readings) {
  return isAdmissible(constants, solution) && isWithinGate(solution, readings);
}

bool isPlain(const TableConstants& constants, const Solution& solution, const ScaledReadings& readings) {
  return isAdmissible(constants, solution) &&
         isWithin(solution, readings, energyOf(readings, doubt(solution.hypothesis)));
}

bool isPlainAsBuilt(const TableConstants& constants, const Solution& solution, const ScaledReadings& readings,
                    bool was) {
  const std::uint32_t noise_q4 = readings.variances.noise_q4,
                      model_q4 = readings.variances.reading_q4 - noise_q4;
  const int times = was ? threshold::kStillAsBuilt : threshold::kAsBuilt;
  const int most = doubt(solution.hypothesis);
  return isAccepted(constants, solution, readings) &&
         isWithin(solution, readings, energyOf(noise_q4, most) + times * energyOf(model_q4, most));
}

bool isFirm(const TableConstants& constants, const Solution& solution, const ScaledReadings& readings) {
  if (solution.hypothesis.gauges != allGauges(constants.gauge_count)) return false;
  if (constants.spacing != RingSpacing::kDense) return false;
  const Number largest = largestReading(readings, solution.hypothesis.gauges);
  const Variances& variances = readings.variances;
  const std::uint32_t aside_q4 = variances.noise_q4 + ((variances.largest_q4 - variances.noise_q4) >> 4);
  if (Wide{largest} * largest < energyOf(aside_q4, threshold::kFirmSignal)) return false;
  for (const ContactState& contact : solution.contacts())
    if (solution.hypothesis.widthIsFree &&
        (Wide{contact.moment_q20} * constants.largest_moment_um2 >> kMomentBits) > threshold::kFirmMoment_um2)
      return false;
  return true;
}

}  // namespace strainfinger::firmware
