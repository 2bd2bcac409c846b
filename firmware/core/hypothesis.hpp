#pragma once
// What may have made the readings: how many contacts, with which unknowns, read by which gauges.

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

/// Of an array.
constexpr std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Bit i: gauge i.
using GaugeSet = std::uint32_t;

constexpr GaugeSet allGauges(int count) { return ~GaugeSet{0} >> (kMaxGauges - count); }
constexpr bool contains(GaugeSet gauges, int gauge) { return (gauges >> gauge & 1) != 0; }

/// Those beside gauges of a ring of so many.
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

inline constexpr int kMostContacts = 2;

/// A contact in the units of the fit.
struct ContactState {
  std::uint32_t angle_q32 = 0;  ///< TurnQ32
  Number normal = 0;      ///< amplitude: scaled readings * 2 where the response is largest, within kMostLoad
  Number tangential = 0;  ///< the same
  Number moment_q20 = 0;  ///< second moment of the pressure, see kMomentBits

  bool operator==(const ContactState&) const = default;
};

inline constexpr Number kMostLoad = 1 << 20;

/// A load may be beyond what a fit holds: gauges at their rails leave it open.
inline bool isLimited(const ContactState& contact) {
  return larger(magnitude(contact.normal), magnitude(contact.tangential)) >= kMostLoad;
}

/// Which contacts are sought with which unknowns. Line or wide contact, one or two, with or without some
/// gauges: all are solved by the same fit.
struct Hypothesis {
  std::uint8_t contacts = 1;
  bool widthIsFree = true;
  GaugeSet gauges = 0;  ///< whose readings count
  GaugeSet exact = 0;   ///< if any, only these are fitted; the others judge

  constexpr int unknowns() const { return contacts * (widthIsFree ? 4 : 3); }
  bool operator==(const Hypothesis&) const = default;
};

/// One contact, of unknown width where the tables don't know it and `isWidthFitted`.
constexpr Hypothesis oneContact(const TableConstants& constants, GaugeSet gauges, bool isWidthFitted = true) {
  return {1, constants.width_is_known == 0 && isWidthFitted, gauges};
}

using ContactStates = std::array<ContactState, kMostContacts>;

/// Of one scaled reading [* 2^4].
struct Variances {
  std::uint32_t reading_q4 = 0;  ///< noise, rounding and the least of the model's error: of weight 1
  std::uint32_t noise_q4 = 0;    ///< noise and rounding alone, which jitter from set to set
  std::uint32_t largest_q4 = 0;  ///< noise, rounding and the model's error of the largest reading
};

/// The finger as it is built differs from the one in the tables. Besides noise and rounding a reading is
/// therefore off by `model_error` of itself (gains), of this part [log2] of what each neighbour reads (a
/// gauge that is glued off its place reads more like them), and of this part [log2] of the largest reading,
/// whatever it reads itself. These standard deviations are added, not their squares.
inline constexpr int kNeighbourBits = 3, kLeastErrorBits = 4;

/// By what each gauge's residual and columns are multiplied [* 2^14]: the standard deviation of a gauge that
/// reads nothing over its own. Then Variances::reading_q4 is the variance of all.
using Weights = std::array<Short, kMaxGauges>;
inline constexpr int kWeightBits = 14;
inline const Weights kAllAlike = [] {
  Weights weight_q14;
  weight_q14.fill(1 << kWeightBits);
  return weight_q14;
}();

/// The readings of a ring as 16-bit numbers: strain * 2^32 / 2^shift, the largest in [2^14, 2^15) unless all
/// are tiny. Half a step of rounding is part of the variance.
struct ScaledReadings {
  std::array<Short, kMaxGauges> value;  ///< of the gauges that there are
  Weights weight_q14 = kAllAlike;
  Variances variances;
  std::int8_t shift = 0;

  Number weighted(std::size_t gauge) const { return (value[gauge] * weight_q14[gauge]) >> kWeightBits; }
  /// What a prediction leaves of a reading, by its weight.
  Number left(std::size_t gauge, Number predicted) const {
    return scaled<kWeightBits>(value[gauge] - predicted, weight_q14[gauge]);
  }
};

/// Variance of a reading as configured [in configured ones * 2^4].
inline constexpr std::uint32_t kConfiguredNoise_q4 = 1 << 4;

/// Rounding of a reading and of its prediction: 1/12 each, and what is lost in the columns [* 2^4].
inline constexpr std::uint32_t kRoundingVariance_q4 = 4;
inline constexpr std::uint32_t kMostVariance_q4 = 0x7FFFFFFF;

/// Of configured noise in readings divided by 2^shift [* 2^4].
inline std::uint32_t noiseVariance_q4(const TableConstants& constants, int shift) {
  const int up = constants.noise_variance_exponent + 4 - 2 * shift;
  if (up <= -32) return 0;
  if (up < 0) return constants.noise_variance >> -up;
  if (up >= 8 || constants.noise_variance > kMostVariance_q4 >> up) return kMostVariance_q4;
  return constants.noise_variance << up;
}

/// How far each reading may be trusted, of variances that are known. Gauges that don't count may read as much
/// as the largest of those that do.
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

/// `gauges`: those that count when the scale and the model's error are chosen; others may saturate.
/// `noise_q4`: variance of a reading in configured ones [* 2^4].
/// `shift`: the one to keep while the largest reading stays in [2^13, 2^15); negative: none.
/// `beyond_q32`: size of the largest reading at a rail, which does not count and is part of the touch.
inline ScaledReadings scaledReadings(const TableConstants& constants, std::span<const Number> strains_q32,
                                     GaugeSet gauges, std::uint32_t noise_q4 = kConfiguredNoise_q4,
                                     int shift = -1, Number beyond_q32 = 0) {
  Number largest = beyond_q32;
  for (std::size_t i = 0; i < strains_q32.size(); ++i)
    if (contains(gauges, static_cast<int>(i))) largest = larger(largest, signlessBits(strains_q32[i]));
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

/// The same contacts where readings are divided by 2^to instead of 2^from.
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
