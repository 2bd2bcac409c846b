#include "firmware/core/estimate.hpp"

#include <algorithm>

#include "firmware/core/error_products.hpp"
#include "firmware/core/triple_fit.hpp"
#include "firmware/core/units.hpp"

namespace strainfinger::firmware {
namespace {

constexpr std::uint8_t kUncertainQuality = 20;
constexpr int kRoundingShift = 12;  ///< 1/4096 of the energy is lost in rounding

/// Variance of a reading, as an energy of the fit (a quarter of a squared scaled strain).
Scaled noiseOf(const TableConstants& constants, const Fit& fit) {
  return {constants.noise_variance, constants.noise_variance_exponent - 2 * (16 - fit.up) - 2};
}

/// Standard errors of an answer's offset [pitches * 2^20] and amplitudes.
struct Errors {
  std::int32_t offset, normal, tangential;
};

Errors refinedErrors(Scaled noise, const Fit& fit) {
  const AmplitudeSlopes slopes = amplitudeSlopes(*fit.row, fit.projection);
  const auto& load = fit.row->load;
  const std::int32_t offset = offsetSigma(noise, fit.information, fit.row->gradient_exponent);
  return {offset, amplitudeSigma(noise, {load[0], load[1]}, slopes.normal, offset),
          amplitudeSigma(noise, {0, load[2]}, slopes.tangential, offset)};
}

Errors reducedErrors(Scaled noise, const Fit& fit, PitchQ20 mostOffset) {
  const AmplitudeSlopes slopes = amplitudeSlopes(*fit.row, fit.projection);
  const auto& load = fit.row->load;
  const std::int32_t offset =
      std::min(offsetSigma(noise, fit.information, fit.row->gradient_exponent), mostOffset);
  const auto sigma = [&](const Deviations& deviations) {
    return reducedSigma(deviations, fit.covariance_q12);
  };
  return {sigma({0, 0, offset}), sigma(deviationsOf(noise, {load[0], load[1]}, slopes.normal, offset)),
          sigma(deviationsOf(noise, {0, load[2]}, slopes.tangential, offset))};
}

Errors tripleErrors(Scaled noise, const Fit& fit) {
  constexpr int kLowered = 20;
  const TripleSystem system = systemOf(*fit.row, fit.triple, fit.projection);
  const AmplitudeSlopes slopes = amplitudeSlopes(*fit.row, fit.projection);
  const auto& load = fit.row->load;
  // An amplitude changes with the projections, and per row spacing of offset.
  const auto sigma = [&](std::int32_t load1, std::int32_t load2, std::int32_t slope) {
    Vector3 weights;
    for (std::size_t i = 0; i < weights.size(); ++i)
      weights[i] = saturated(amplitudeWeight(*fit.row, system, i, {load1, load2}, slope) >> kLowered);
    return weightedSigma(noise, weights, kLowered, system.volume);
  };
  return {weightedSigma(noise, system.forOffset, kPitchBits - fit.row->gradient_exponent, system.volume),
          sigma(load[0], load[1], slopes.normal), sigma(0, load[2], slopes.tangential)};
}

Errors errorsOf(Scaled noise, const Fit& fit, PitchQ20 mostOffset) {
  if (fit.reduced) return reducedErrors(noise, fit, mostOffset);
  return fit.readings == FitMode::kRefined ? refinedErrors(noise, fit) : tripleErrors(noise, fit);
}

LineLoadQ12 loadOf(const TableConstants& constants, const Fit& fit, std::int32_t amplitude) {
  return LineLoadQ12::fromRaw(
      lineLoad(amplitude, constants.load_scale, constants.load_exponent + 16 - fit.up));
}

/// Angles wrap.
std::uint32_t turnsOf(const TableConstants& constants, PitchQ20 pitches) {
  return static_cast<std::uint32_t>(revolutions(constants.pitch_turn_q35, pitches));
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

/// Standard errors that an alternative is away at least: three, or as many as noise needs to make it the
/// better one; two below eight variances, which are a valley's, maybe longer (runners-up are ambiguous up to
/// 12).
int errorsAway(const TableConstants& constants, const Fit& fit) {
  static_assert(kNoiseUnit == 32);
  if (fit.ambiguous) return 3;
  const std::int32_t eightVariances = noiseEnergy(constants, fit.up) / 4;
  return 2 + (fit.deficit >= eightVariances) + (fit.deficit >= 2 * eightVariances) +
         (fit.deficit >= 3 * eightVariances);
}

/// So that as many errors reach the alternative, and beyond it as far as its own error.
std::int32_t covering(std::int32_t sigma, std::int64_t difference, int errors) {
  const std::int64_t reach = (difference < 0 ? -difference : difference) + sigma;
  return std::max(sigma, saturate<std::int32_t>(reach / errors));
}

}  // namespace

Contact estimate(const TableConstants& constants, const Fit& fit) {
  const PitchQ20 ring = constants.gauge_count * kOnePitch;
  auto [offset, normal, tangential] = errorsOf(noiseOf(constants, fit), fit, ring / 2);
  offset = std::min(offset, ring / 2);
  if (fit.deficit != kNoRival) {
    const int errors = errorsAway(constants, fit);
    const PitchQ20 apart = std::abs(fit.best.position - fit.alternative.position);
    offset = covering(offset, std::min(apart, ring - apart), errors);
    normal = covering(normal, std::int64_t{fit.best.normal} - fit.alternative.normal, errors);
    tangential = covering(tangential, std::int64_t{fit.best.tangential} - fit.alternative.tangential, errors);
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
