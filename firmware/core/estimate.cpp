#include "firmware/core/estimate.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "firmware/core/integer_root.hpp"

namespace strainfinger::firmware {
namespace {

constexpr std::uint8_t kUncertainQuality = 20;

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
Scaled noiseEnergy(const TableConstants& constants, const Fit& fit) {
  return {constants.noise_variance, constants.noise_variance_exponent - 2 * fit.shift - 2};
}

/// Standard error of the offset [pitches * 2^20]: noise over the information in its gradient.
std::int32_t offsetSigma(const TableConstants& constants, const Fit& fit) {
  if (fit.information <= 0) return kOnePitch;
  const int up = std::countl_zero(static_cast<std::uint32_t>(fit.information)) - 16;
  const auto information =
      static_cast<std::uint32_t>(up >= 0 ? fit.information << up : fit.information >> -up);
  Scaled variance = noiseEnergy(constants, fit);
  variance.mantissa = (variance.mantissa << 7) / information;
  variance.exponent += up - 2 * fit.informationExponent - 7 + 2 * kPitchBits;
  return root(variance);
}

/// Standard error of an amplitude: its own at a known offset, and what the offset's error adds.
std::int32_t amplitudeSigma(const TableConstants& constants, const Fit& fit, std::uint32_t gainSquared,
                            std::int32_t slope, std::int32_t offset_sigma) {
  Scaled own = noiseEnergy(constants, fit);
  own.mantissa *= gainSquared;
  const std::int64_t carried = std::clamp<std::int64_t>((std::int64_t{slope} * offset_sigma) >> kRowBits,
                                                        -(std::int64_t{1} << 30), std::int64_t{1} << 30);
  return root({plain(own) + static_cast<std::uint64_t>(carried * carried), 0});
}

/// Standard errors of an amplitude along the three directions in which a contact moves the readings, were
/// these told by all gauges: by its loads' coefficients, and carried over from the offset.
using Deviations = std::array<std::int64_t, 3>;

Deviations deviationsOf(const TableConstants& constants, const Fit& fit, std::array<std::int16_t, 2> gains,
                        std::int32_t slope, std::int32_t offset_sigma) {
  Scaled noise = noiseEnergy(constants, fit);
  noise.exponent += 16;
  const std::int64_t deviation = root(noise);
  return {(gains[0] * deviation) >> 8, (gains[1] * deviation) >> 8,
          (std::int64_t{slope} * offset_sigma) >> kRowBits};
}

/// The root of d C d, with C what the remaining gauges tell of the three (Fit::covariance_q12).
std::int32_t reducedSigma(Deviations deviations, const std::array<std::int32_t, 6>& covariance_q12) {
  std::int64_t largest = 0;
  for (const std::int64_t each : deviations) largest = std::max(largest, std::abs(each));
  const int down = std::max(64 - std::countl_zero(static_cast<std::uint64_t>(largest)) - 19, 0);
  for (std::int64_t& each : deviations) each >>= down;
  const auto& [d1, d2, d3] = deviations;
  const auto& [c11, c12, c13, c22, c23, c33] = covariance_q12;
  const std::int64_t variance =
      d1 * d1 * c11 + d2 * d2 * c22 + d3 * d3 * c33 + 2 * (d1 * d2 * c12 + d1 * d3 * c13 + d2 * d3 * c23);
  return root({static_cast<std::uint64_t>(std::max<std::int64_t>(variance, 0)), 2 * down - 12});
}

std::uint32_t squareOf(std::int16_t value) { return static_cast<std::uint32_t>(std::int32_t{value} * value); }

LineLoadQ12 loadOf(const TableConstants& constants, const Fit& fit, std::int32_t amplitude) {
  const int up = constants.load_exponent + fit.shift;
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

std::uint8_t qualityOf(const Fit& fit) {
  const std::int64_t percent =
      100 * std::int64_t{fit.expected} / std::max<std::int32_t>({fit.expected, fit.unexplained, 1});
  const bool doubt = fit.ambiguous || !fit.settled;
  return static_cast<std::uint8_t>(std::min<std::int64_t>(percent, doubt ? kUncertainQuality : 100));
}

/// Two answers a distance apart: the reported error is at least a third of it.
std::int32_t covering(std::int32_t sigma, std::int64_t difference) {
  return std::max(sigma, saturate<std::int32_t>((difference < 0 ? -difference : difference) / 3));
}

}  // namespace

Contact estimate(const TableConstants& constants, const Fit& fit) {
  std::int32_t offset = std::min(offsetSigma(constants, fit), constants.gauge_count * kOnePitch / 2);
  const std::uint32_t normalGain = squareOf(fit.load[0]) + squareOf(fit.load[1]);
  std::int32_t normal = amplitudeSigma(constants, fit, normalGain, fit.normalSlope, offset);
  std::int32_t tangential =
      amplitudeSigma(constants, fit, squareOf(fit.load[2]), fit.tangentialSlope, offset);
  if (fit.reduced) {
    normal = reducedSigma(deviationsOf(constants, fit, {fit.load[0], fit.load[1]}, fit.normalSlope, offset),
                          fit.covariance_q12);
    tangential = reducedSigma(deviationsOf(constants, fit, {0, fit.load[2]}, fit.tangentialSlope, offset),
                              fit.covariance_q12);
    offset = reducedSigma({0, 0, offset}, fit.covariance_q12);
  }
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
  contact.quality = qualityOf(fit);
  contact.ambiguous = fit.ambiguous;
  contact.uncertain = contact.quality <= kUncertainQuality;
  return contact;
}

}  // namespace strainfinger::firmware
