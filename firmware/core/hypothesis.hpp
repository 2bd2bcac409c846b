#pragma once
// Hypotheses (how many contacts, with which unknowns, read by which gauges), and readings as integers.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/quantities.hpp"
#include "common/table_image.hpp"
#include "firmware/core/integers.hpp"
#include "firmware/core/units.hpp"

namespace strainfinger::firmware {

constexpr std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Bit i: gauge i.
using GaugeSet = std::uint32_t;

constexpr GaugeSet allGauges(int count) { return ~GaugeSet{0} >> (kMaxGauges - count); }
constexpr bool contains(GaugeSet gauges, int gauge) { return (gauges >> gauge & 1) != 0; }

/// The gauges next to these, in a ring of `count` gauges.
constexpr GaugeSet neighboursOf(GaugeSet gauges, int count) {
  return (gauges << 1 | gauges >> (count - 1) | gauges >> 1 | gauges << (count - 1)) & allGauges(count);
}

/// The gap between two gauges of an even ring.
constexpr std::uint32_t pitch_q32(const TableConstants& constants) {
  const std::uint32_t count = constants.gauge_count;
  return (0 - count) / count + 1;  // 2^32 / count
}

/// How far two angles are apart, the shorter way round.
constexpr std::uint32_t apart_q32(std::uint32_t a_q32, std::uint32_t b_q32) {
  return std::min(a_q32 - b_q32, b_q32 - a_q32);
}

/// apart_q32() is at most this, which is less than half a turn; in fewer instructions.
constexpr bool areWithin_q32(std::uint32_t a_q32, std::uint32_t b_q32, std::uint32_t most_q32) {
  return a_q32 - b_q32 + most_q32 <= 2 * most_q32;
}

/// The largest magnitude among these gauges, of which there are strains, to within 1.
inline Number largestOf(std::span<const Number> strains_q32, GaugeSet gauges) {
  Number largest = 0;
  for (std::size_t i = 0; gauges != 0; ++i, gauges >>= 1)
    if (contains(gauges, 0)) largest = larger(largest, signlessBits(strains_q32[i]));
  return largest;
}

inline constexpr int kMostContacts = 2;

/// A contact in the units of the fit.
struct ContactState {
  std::uint32_t angle_q32 = 0;  ///< TurnQ32
  Number normal = 0;  ///< amplitude: twice the scaled reading where the response is largest; within kMostLoad
  Number tangential = 0;  ///< the same for the tangential load
  Number moment_q20 = 0;  ///< second moment of the pressure, see kMomentBits

  bool operator==(const ContactState&) const = default;
};

inline constexpr Number kMostLoad = 1 << 20;

/// A load is at the fit's limit and may be larger in truth: gauges at their rails leave that open.
inline bool isLimited(const ContactState& contact) {
  return larger(magnitude(contact.normal), magnitude(contact.tangential)) >= kMostLoad;
}

/// How many contacts are fitted to which gauges, with which unknowns. Line or wide contact, one or two, with
/// or without some gauges: all are solved by the same fit.
struct Hypothesis {
  std::uint8_t contacts = 1;
  bool widthIsFree = true;
  GaugeSet gauges = 0;  ///< whose readings count
  GaugeSet exact = 0;   ///< if any, only these are fitted; the residuals of the others still count

  constexpr int unknowns() const { return contacts * (widthIsFree ? 4 : 3); }
  bool operator==(const Hypothesis&) const = default;
};

/// One contact. Its width is an unknown unless the tables know it or `isWidthFitted` is false.
constexpr Hypothesis oneContact(const TableConstants& constants, GaugeSet gauges, bool isWidthFitted = true) {
  return {1, constants.width_is_known == 0 && isWidthFitted, gauges};
}

using ContactStates = std::array<ContactState, kMostContacts>;

/// Variances of one scaled reading [* 2^4].
struct Variances {
  std::uint32_t reading_q4 = 0;  ///< noise, rounding, model error of a gauge that reads nothing: weight 1
  std::uint32_t noise_q4 = 0;    ///< noise and rounding alone, which differ from set to set
  std::uint32_t largest_q4 = 0;  ///< noise, rounding and the model error of the largest reading
};

/// The finger as it is built differs from the one in the tables. A reading's model error is therefore a sum
/// of three standard deviations (not of their squares): `model_error` times the reading itself (gains), times
/// 1/2^kNeighbourBits of each neighbour's (a gauge glued off its place reads more like them), and times
/// 1/2^kLeastErrorBits of the largest reading, whatever the gauge reads itself.
inline constexpr int kNeighbourBits = 3, kLeastErrorBits = 4;

/// What each gauge's residual and columns are multiplied by [* 2^14]: the standard deviation of a gauge that
/// reads nothing over the gauge's own. Then Variances::reading_q4 is the variance of all of them.
using Weights = std::array<Short, kMaxGauges>;
inline constexpr int kWeightBits = 14;
inline const Weights kAllAlike = [] {
  Weights weight_q14;
  weight_q14.fill(1 << kWeightBits);
  return weight_q14;
}();

/// The readings of a ring as 16-bit numbers: strain * 2^32 / 2^shift, the largest in [2^14, 2^15) unless all
/// are tiny or an earlier shift is kept. The variances include rounding.
struct ScaledReadings {
  std::array<Short, kMaxGauges> value;  ///< only of the ring's gauges; the rest is not set
  Weights weight_q14 = kAllAlike;
  Variances variances;
  std::int8_t shift = 0;

  Number weighted(std::size_t gauge) const { return (value[gauge] * weight_q14[gauge]) >> kWeightBits; }
  /// The weighted residual of a reading.
  Number left(std::size_t gauge, Number predicted) const {
    return scaled<kWeightBits>(value[gauge] - predicted, weight_q14[gauge]);
  }
};

/// The noise's variance is given over the configured one [* 2^4]; this stands for the configured one itself.
inline constexpr std::uint32_t kConfiguredNoise_q4 = 1 << 4;

/// Variance of rounding [* 2^4]: 1/12 each for a reading and its prediction, the rest for the columns.
inline constexpr std::uint32_t kRoundingVariance_q4 = 4;
inline constexpr std::uint32_t kMostVariance_q4 = 0x7FFFFFFF;

/// Variance of the configured noise in readings divided by 2^shift [* 2^4].
inline std::uint32_t noiseVariance_q4(const TableConstants& constants, int shift) {
  const int up = constants.noise_variance_exponent + 4 - 2 * shift;
  if (up <= -32) return 0;
  if (up < 0) return constants.noise_variance >> -up;
  if (up >= 8 || constants.noise_variance > kMostVariance_q4 >> up) return kMostVariance_q4;
  return constants.noise_variance << up;
}

/// Sets the weights, from variances that are set already. A gauge that doesn't count may read as much as
/// `largest`, which matters for its neighbours' model errors.
inline void weigh(const TableConstants& constants, GaugeSet counted, Number largest,
                  ScaledReadings& readings) {
  const int gauges = constants.gauge_count;
  const auto least_q2 = static_cast<Number>(integerRoot(readings.variances.reading_q4));
  const auto size = [&](int gauge) {
    return contains(counted, gauge) ? magnitude(Number{readings.value[index(gauge)]}) : largest;
  };
  Number before = size(gauges - 1), here = size(0);
  for (int gauge = 0; gauge < gauges; ++gauge) {
    const Number next = size(gauge + 1 == gauges ? 0 : gauge + 1);
    const Number reads = here + ((before + next) >> kNeighbourBits);
    const Number own_q2 = ((reads >> 1) * constants.model_error_q16) >> 13;
    readings.weight_q14[index(gauge)] = static_cast<Short>((least_q2 << kWeightBits) / (least_q2 + own_q2));
    before = here;
    here = next;
  }
}

/// `gauges`: those by which the scale and the model error are chosen; others may saturate.
/// `noise_q4`: the noise's variance over the configured one [* 2^4].
/// `shift`: kept if it leaves the largest reading in [2^13, 2^15); negative: none to keep.
/// `beyond_q32`: magnitude of the largest reading at a rail, which is not fitted but is part of the touch.
inline ScaledReadings scaledReadings(const TableConstants& constants, std::span<const Number> strains_q32,
                                     GaugeSet gauges, std::uint32_t noise_q4 = kConfiguredNoise_q4,
                                     int shift = -1, Number beyond_q32 = 0) {
  Number largest = larger(beyond_q32, largestOf(strains_q32, gauges));
  ScaledReadings scaled;
  const int own = std::max(bitWidth(largest) - 15, 0);
  scaled.shift = static_cast<std::int8_t>(shift == own + 1 ? shift : own);
  largest = largest >> scaled.shift;
  for (std::size_t i = 0; i < strains_q32.size(); ++i)
    scaled.value[i] = shortened(strains_q32[i] >> scaled.shift);
  const Natural modelError = static_cast<Natural>(largest) * constants.model_error_q16 >> 14;  // * 4
  const Natural noise =
      (Natural{noiseVariance_q4(constants, scaled.shift)} * noise_q4 >> 4) + kRoundingVariance_q4;
  const auto withModelError = [&](Natural error) {
    return static_cast<std::uint32_t>(std::min<Natural>(error * error + noise, kMostVariance_q4));
  };
  scaled.variances = {withModelError(modelError >> kLeastErrorBits), withModelError(0),
                      withModelError(modelError)};
  if (constants.model_error_q16 != 0) weigh(constants, gauges, largest, scaled);
  return scaled;
}

/// The same contacts for readings divided by 2^to instead of 2^from.
inline ContactStates rescaled(const ContactStates& contacts, int from, int to) {
  ContactStates scaled = contacts;
  if (from == to) return scaled;
  for (ContactState& contact : scaled) {
    contact.normal = shifted(contact.normal, from - to, kMostLoad);
    contact.tangential = shifted(contact.tangential, from - to, kMostLoad);
  }
  return scaled;
}

}  // namespace strainfinger::firmware
