#include "firmware/core/estimate.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "firmware/core/error_products.hpp"
#include "firmware/core/integer_root.hpp"
#include "firmware/core/triple_fit.hpp"

namespace strainfinger::firmware {
namespace {

constexpr std::uint8_t kUncertainQuality = 20;
constexpr int kRoundingShift = 12;  ///< 1/4096 of the energy is lost in rounding

/// A positive real number: mantissa * 2^exponent. Cheap to multiply, and its root costs one integer root.
struct Scaled {
  std::uint64_t mantissa = 0;
  int exponent = 0;
};

/// sqrt(value) rounded down to 16 significant bits, saturating at 2^31 - 1.
std::int32_t root(Scaled value) {
  if (value.mantissa == 0) return 0;
  int up = std::countl_zero(value.mantissa);
  if ((value.exponent - up) % 2 != 0) --up;
  const auto top = static_cast<std::uint32_t>((value.mantissa << up) >> 32);
  const int exponent = (value.exponent - up + 32) / 2;
  const std::uint32_t digits = integerRoot(top);
  if (exponent <= -32) return 0;
  if (exponent < 0) return static_cast<std::int32_t>(digits >> -exponent);
  return exponent > 15 ? std::numeric_limits<std::int32_t>::max()
                       : saturate<std::int32_t>(std::int64_t{digits} << exponent);
}

/// value as a plain integer; saturating at 2^62.
std::uint64_t plain(Scaled value) {
  if (value.exponent <= 0) return value.exponent > -64 ? value.mantissa >> -value.exponent : 0;
  constexpr std::uint64_t kLimit = std::uint64_t{1} << 62;
  return value.exponent < std::countl_zero(value.mantissa) - 1 ? value.mantissa << value.exponent : kLimit;
}

/// Variance of a reading, as an energy of the fit (a quarter of a squared scaled strain).
Scaled noiseOf(const TableConstants& constants, const Fit& fit) {
  return {constants.noise_variance, constants.noise_variance_exponent - 2 * (16 - fit.up) - 2};
}

/// Standard error of the offset [pitches * 2^20]: noise over the information in its gradient.
std::int32_t offsetSigma(const TableConstants& constants, const Fit& fit) {
  if (fit.information <= 0) return kOnePitch;
  const int up = std::countl_zero(static_cast<std::uint32_t>(fit.information)) - 16;
  const auto information =
      static_cast<std::uint32_t>(up >= 0 ? fit.information << up : fit.information >> -up);
  Scaled variance = noiseOf(constants, fit);
  variance.mantissa = (variance.mantissa << 7) / information;
  variance.exponent += up - 2 * (fit.row->gradient_exponent + 1) - 7 + 2 * kPitchBits;
  return root(variance);
}

/// Standard error of an amplitude: its own at a known offset, and what the offset's error adds.
std::int32_t amplitudeSigma(const TableConstants& constants, const Fit& fit, std::uint32_t gainSquared,
                            std::int32_t slope, std::int32_t offset_sigma) {
  Scaled own = noiseOf(constants, fit);
  own.mantissa *= gainSquared;
  const std::int64_t carried = std::clamp<std::int64_t>((std::int64_t{slope} * offset_sigma) >> kRowBits,
                                                        -(std::int64_t{1} << 30), std::int64_t{1} << 30);
  return root({plain(own) + static_cast<std::uint64_t>(carried * carried), 0});
}

std::uint32_t squareOf(std::int16_t value) { return static_cast<std::uint32_t>(std::int32_t{value} * value); }

/// Standard errors of an answer's offset [pitches * 2^20] and amplitudes.
struct Errors {
  std::int32_t offset, normal, tangential;
};

Errors refinedErrors(const TableConstants& constants, const Fit& fit) {
  const AmplitudeSlopes slopes = amplitudeSlopes(*fit.row, fit.projection);
  const auto& load = fit.row->load;
  const std::int32_t offset = offsetSigma(constants, fit);
  return {offset,
          amplitudeSigma(constants, fit, squareOf(load[0]) + squareOf(load[1]), slopes.normal, offset),
          amplitudeSigma(constants, fit, squareOf(load[2]), slopes.tangential, offset)};
}

/// Standard errors of an amplitude along the three directions in which a contact moves the readings, were
/// these told by all gauges: by its loads' coefficients, and carried over from the offset.
using Deviations = std::array<Wide, 3>;

Deviations deviationsOf(const TableConstants& constants, const Fit& fit, std::array<std::int16_t, 2> gains,
                        std::int32_t slope, std::int32_t offset_sigma) {
  Scaled noise = noiseOf(constants, fit);
  noise.exponent += 16;
  const std::int64_t deviation = root(noise);
  return {(gains[0] * deviation) >> 8, (gains[1] * deviation) >> 8,
          (std::int64_t{slope} * offset_sigma) >> kRowBits};
}

/// The root of d C d, with C what the remaining gauges tell of the three (Fit::covariance_q12).
std::int32_t reducedSigma(Deviations deviations, const std::array<std::int32_t, 6>& covariance_q12) {
  std::int64_t largest = 0;
  for (const std::int64_t each : deviations) largest = std::max(largest, std::abs(each));
  const int down = std::max(64 - std::countl_zero(static_cast<std::uint64_t>(largest)) - kDeviationBits, 0);
  for (std::int64_t& each : deviations) each >>= down;
  const Wide variance = quadraticForm(deviations, covariance_q12);
  return root({static_cast<std::uint64_t>(std::max<std::int64_t>(variance, 0)), 2 * down - 12});
}

Errors reducedErrors(const TableConstants& constants, const Fit& fit) {
  const AmplitudeSlopes slopes = amplitudeSlopes(*fit.row, fit.projection);
  const auto& load = fit.row->load;
  const std::int32_t offset = std::min(offsetSigma(constants, fit), constants.gauge_count * kOnePitch / 2);
  const auto sigma = [&](const Deviations& deviations) {
    return reducedSigma(deviations, fit.covariance_q12);
  };
  return {sigma({0, 0, offset}),
          sigma(deviationsOf(constants, fit, {load[0], load[1]}, slopes.normal, offset)),
          sigma(deviationsOf(constants, fit, {0, load[2]}, slopes.tangential, offset))};
}

/// value with 32 significant bits.
Scaled normalised(std::uint64_t value) {
  const int up = std::countl_zero(value | 1);
  return {value << up >> 32, 32 - up};
}

/// Standard error of a sum of three readings, each times weight * 2^weightExponent / volume.
std::int32_t weightedSigma(const TableConstants& constants, const Fit& fit, const Vector3& weights,
                           int weightExponent, std::int32_t volume) {
  if (volume == 0) return std::numeric_limits<std::int32_t>::max();
  std::uint64_t square = 0;
  for (const std::int32_t weight : weights)
    square += static_cast<std::uint64_t>(std::int64_t{weight} * weight);
  const Scaled above = normalised(square);
  const Scaled below = normalised(static_cast<std::uint64_t>(std::int64_t{volume} * volume));
  const Scaled noise = noiseOf(constants, fit);
  // A reading's variance is four times its energy.
  return root({noise.mantissa * above.mantissa / below.mantissa,
               noise.exponent + 2 + above.exponent - below.exponent + 2 * weightExponent});
}

Errors tripleErrors(const TableConstants& constants, const Fit& fit) {
  constexpr int kLowered = 20;
  const TripleSystem system = systemOf(*fit.row, fit.triple, fit.projection);
  const AmplitudeSlopes slopes = amplitudeSlopes(*fit.row, fit.projection);
  const auto& load = fit.row->load;
  // An amplitude changes with the projections, and per row spacing of offset.
  const auto sigma = [&](std::int32_t load1, std::int32_t load2, std::int32_t slope) {
    Vector3 weights;
    for (std::size_t i = 0; i < weights.size(); ++i)
      weights[i] =
          saturate<std::int32_t>(amplitudeWeight(*fit.row, system, i, {load1, load2}, slope) >> kLowered);
    return weightedSigma(constants, fit, weights, kLowered, system.volume);
  };
  return {
      weightedSigma(constants, fit, system.forOffset, kPitchBits - fit.row->gradient_exponent, system.volume),
      sigma(load[0], load[1], slopes.normal), sigma(0, load[2], slopes.tangential)};
}

Errors errorsOf(const TableConstants& constants, const Fit& fit) {
  if (fit.reduced) return reducedErrors(constants, fit);
  return fit.readings == FitMode::kRefined ? refinedErrors(constants, fit) : tripleErrors(constants, fit);
}

LineLoadQ12 loadOf(const TableConstants& constants, const Fit& fit, std::int32_t amplitude) {
  const int up = constants.load_exponent + 16 - fit.up;
  const std::int64_t product = std::int64_t{amplitude} * constants.load_scale;
  if (up >= 0) return LineLoadQ12::max();
  if (up <= -63) return LineLoadQ12::fromRaw(0);
  const std::int64_t half = std::int64_t{1} << (-up - 1);
  return LineLoadQ12::fromRaw(saturate<std::int32_t>((product + half) >> -up));
}

std::uint32_t turnsOf(const TableConstants& constants, PitchQ20 pitches) {
  const std::uint64_t turns = static_cast<std::uint64_t>(pitches) * constants.pitch_turn_q35;
  return static_cast<std::uint32_t>((turns + (1u << 22)) >> 23);
}

TurnQ32 angleOf(const TableConstants& constants, PitchQ20 position) {
  return TurnQ32::fromRaw(constants.first_angle_q32 + turnsOf(constants, position));
}

/// 100 % where noise and rounding explain what is left.
std::uint8_t qualityOf(const TableConstants& constants, const Fit& fit) {
  const std::int32_t expected = noiseEnergy(constants, fit.up) / 2 + (fit.windowEnergy >> kRoundingShift);
  const std::int64_t percent =
      100 * std::int64_t{expected} / std::max<std::int32_t>({expected, fit.unexplained, 1});
  const bool doubt = fit.ambiguous || !fit.settled;
  return static_cast<std::uint8_t>(std::min<std::int64_t>(percent, doubt ? kUncertainQuality : 100));
}

/// Two answers a distance apart: the reported error is at least a third of it.
std::int32_t covering(std::int32_t sigma, std::int64_t difference) {
  return std::max(sigma, saturate<std::int32_t>((difference < 0 ? -difference : difference) / 3));
}

}  // namespace

Contact estimate(const TableConstants& constants, const Fit& fit) {
  auto [offset, normal, tangential] = errorsOf(constants, fit);
  offset = std::min(offset, constants.gauge_count * kOnePitch / 2);
  if (fit.ambiguous) {
    const PitchQ20 ring = constants.gauge_count * kOnePitch;
    const PitchQ20 apart = std::abs(fit.best.position - fit.alternative.position);
    offset = covering(offset, std::min(apart, ring - apart));
    normal = covering(normal, std::int64_t{fit.best.normal} - fit.alternative.normal);
    tangential = covering(tangential, std::int64_t{fit.best.tangential} - fit.alternative.tangential);
  }
  Contact contact;
  contact.angle = angleOf(constants, fit.best.position);
  contact.sigmaAngle = TurnQ32::fromRaw(turnsOf(constants, offset));
  contact.normal = loadOf(constants, fit, fit.best.normal);
  contact.sigmaNormal = loadOf(constants, fit, normal);
  contact.tangential = loadOf(constants, fit, fit.best.tangential);
  contact.sigmaTangential = loadOf(constants, fit, tangential);
  contact.alternative = angleOf(constants, fit.alternative.position);
  contact.quality = qualityOf(constants, fit);
  contact.ambiguous = fit.ambiguous;
  contact.uncertain = contact.quality <= kUncertainQuality;
  return contact;
}

}  // namespace strainfinger::firmware
