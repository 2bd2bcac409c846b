#include "host/tables/table_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/fixed_real.hpp"
#include "firmware/core/judge.hpp"
#include "host/base/chi_squared.hpp"
#include "host/base/failure.hpp"
#include "host/config/keys.hpp"
#include "host/config/ring_spacing.hpp"
#include "host/config/strained_gauges.hpp"
#include "host/config/unseen_errors.hpp"
#include "host/tables/gauge_depths.hpp"
#include "host/tables/gauge_gains.hpp"
#include "host/tables/response_table.hpp"

namespace strainfinger::tables {
namespace {

/// Fits may come out of the friction cone by noise: this factor times the coefficient is allowed.
constexpr double kConeMargin = 1.25;
/// Noise alone makes a load without friction look like one with a coefficient of this.
constexpr double kLeastCone = 0.1;

double frictionCone(const config::Contact& contact) {
  return std::max(kConeMargin * contact.friction_coefficient, kLeastCone);
}

struct MantissaExponent {
  double mantissa;  ///< in [2^(bits-1), 2^bits)
  int exponent;
};
MantissaExponent normalised(double value, int bits) {
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  return {std::ldexp(fraction, bits), exponent - bits};
}

template <typename Integer>
Integer rounded(double value) {
  return saturate<Integer>(std::llround(value));
}

std::uint32_t turnOf(double angle_rad) {
  const double turns = angle_rad / (2 * std::numbers::pi);
  return fromReal<TurnQ32>(turns - std::floor(turns)).raw();
}

/// The gate's strains are rounded down: that adds up to one of its steps to a reading, with a mean square of
/// 1/3, and of 1/2 where the noise is much smaller than a step.
constexpr double kGateRounding = 0.5;

void fillNoise(TableConstants& constants, double noise_q32, double fullScale_q32) {
  // The converter spans 2 full scales and the zero may lie anywhere in it: usableGain(), with 1 for rounding.
  constants.gate_shift =
      static_cast<std::uint8_t>(std::max(0.0, std::ceil(std::log2(4 * fullScale_q32 + 3)) - 16));
  const auto variance = normalised(noise_q32 * noise_q32, 24);
  constants.noise_variance = rounded<std::uint32_t>(variance.mantissa);
  constants.noise_variance_exponent = static_cast<std::int8_t>(variance.exponent);
  const double noiseInGate = std::ldexp(noise_q32, -constants.gate_shift);
  const double gateVariance = noiseInGate * noiseInGate + kGateRounding;
  const auto gate = [&](double deviations) {
    return rounded<std::uint32_t>(chiSquaredQuantile(constants.gauge_count, deviations) * gateVariance);
  };
  constants.gate_on = gate(6.0);    // noise alone exceeds it in one sample of a billion
  constants.gate_off = gate(3.09);  // in one of a thousand
}

/// An amplitude of 2 is a reading of the largest response: firmware::ContactState.
void fillLoads(TableConstants& constants, double strainPerLoad) {
  const auto load = normalised(std::ldexp(1 / strainPerLoad, LineLoadQ12::kFracBits - 32 - 1), 31);
  constants.load_scale = rounded<std::int32_t>(load.mantissa);
  constants.load_exponent = static_cast<std::int16_t>(load.exponent);
}

/// What correcting gains makes of the noise, as an RMS, and of the largest full scale.
struct Corrected {
  double noise_strain;
  double full_scale_strain;
};

Corrected corrected(const config::FingerConfig& config, const GaugeGains& gains) {
  const auto factors = correctionFactors(gains, config.gauges.count);
  double squares = 0, largest = 1;  // gauges beyond the ring have a factor of 1
  for (const double factor : factors) {
    squares += factor * factor;
    largest = std::max(largest, factor);
  }
  return {config.gauges.noise_strain * std::sqrt(squares / config.gauges.count),
          config.gauges.full_scale_strain * largest};
}

constexpr std::size_t kLeastInReach = 7;  ///< gauges; of seven 1.7 % of the information is lost
constexpr double kUsualReach = 4.5 / 16;  ///< turns: nine gauges of sixteen

/// Within reach of a contact, wherever it is, are kLeastInReach gauges.
std::uint32_t reach_q32(const std::vector<double>& gaps_turn) {
  const auto count = gaps_turn.size();
  double widest_turn = 0;  // from a gauge to the kLeastInReach-th further
  for (std::size_t first = 0; first < count; ++first) {
    double span_turn = 0;
    for (std::size_t i = 0; i < kLeastInReach; ++i) span_turn += gaps_turn[(first + i) % count];
    widest_turn = std::max(widest_turn, span_turn);
  }
  return fromReal<TurnQ32>(std::max(kUsualReach, widest_turn / 2)).raw();
}

/// Left-justified codes, of 2^16, that count as an end of the converter's range: 26 mV of 3.3 V, because
/// amplifiers stop before the converter does. A third of config::kZeroMargin, so no touch needs them.
constexpr int kRail = 1 << 9;

std::uint16_t fraction_q16(double value) { return rounded<std::uint16_t>(std::ldexp(value, 16)); }

/// The model error, and what standard errors have that no residual shows.
void fillErrors(TableConstants& constants, const config::FingerConfig& config, const ResponseTable& responses,
                double depthError) {
  const config::UnseenErrors errors = config::unseenErrors(config);
  constants.model_error_q16 = fraction_q16(std::hypot(errors.modelError, depthError));
  const double turn = errors.place_m / (2 * std::numbers::pi * config.finger.outer_radius_m);
  constants.place_error_q32 =
      rounded<std::uint32_t>(std::min(std::ldexp(turn, 32), double{kMostPlaceError_q32}));
  constants.load_scale_error_q16 = fraction_q16(errors.loadScale);
  constants.load_error_q16 = fraction_q16(errors.normalShare);
  if (responses.largestMoment_m2 > 0)
    constants.moment_error_q16 = fraction_q16(errors.moment_m2 / responses.largestMoment_m2);
}

TableConstants tableConstants(const config::FingerConfig& config, const GaugeGains& gains,
                              const ResponseTable& responses, double depthError) {
  TableConstants constants{};
  constants.gauge_count = static_cast<std::uint8_t>(config.gauges.count);
  const Corrected ring = corrected(config, gains);
  fillNoise(constants, ring.noise_strain * powerOfTwo(32), ring.full_scale_strain * powerOfTwo(32));
  fillLoads(constants, responses.strainPerUnit);
  constants.reading_gain = rounded<std::int32_t>(config.gauges.full_scale_strain * powerOfTwo(34));
  constants.force_per_load_q16 = rounded<std::uint32_t>(config.finger.length_m * 1000 * powerOfTwo(16));
  constants.friction_q8 = rounded<std::uint16_t>(config.contact.friction_coefficient * 256);
  constants.cone_q8 = rounded<std::uint16_t>(frictionCone(config.contact) * 256);
  fillErrors(constants, config, responses, depthError);
  constants.spacing = config::spacingOf(config);
  constants.adc_rail = 0x10000 - kRail;
  constants.mirror_sign = config.gauges.component == StrainComponent::kShear ? -1 : 1;
  constants.peak_sign = static_cast<std::int8_t>(responses.peakSign);
  return constants;
}

void fillMoments(TableConstants& constants, const config::FingerConfig& config,
                 const ResponseTable& responses) {
  const config::Contact& contact = config.contact;
  constants.node_count = static_cast<std::uint16_t>(responses.nodes);
  constants.cell_count = static_cast<std::uint8_t>(responses.cells);
  constants.cell_edge_q15 = responses.cell_edge_q15;
  for (std::size_t k = 0; k < constants.cell_count; ++k)
    constants.cell_rate_q8[k] = saturate<std::uint16_t>(
        (2 << (15 + 8)) / (constants.cell_edge_q15[k + 1] - constants.cell_edge_q15[k]));
  constants.largest_moment_um2 = rounded<std::uint32_t>(responses.largestMoment_m2 * 1e12);
  constants.width_is_known = contact.width_m ? 1 : 0;
  constants.known_moment_q20 = contact.width_m.value_or(0) > 0 ? 1u << kMomentBits : 0;
}

/// From each gauge to the next, in turns.
std::vector<double> gapsOf(const GaugeAngles& angles_q32, std::size_t count) {
  std::vector<double> gaps_turn;
  for (std::size_t i = 0; i < count; ++i)
    gaps_turn.push_back(toReal(TurnQ32::fromRaw(angles_q32[(i + 1) % count] - angles_q32[i])));
  return gaps_turn;
}

/// Steps of load that a full scale must have at least, for errors of a few per thousand.
constexpr double kLeastFullScale = 1024;

/// Readings and loads must fit the firmware's integers.
void requireFormats(const config::FingerConfig& config, double strainPerLoad) {
  const config::Gauges& gauges = config.gauges;
  const double step = powerOfTwo(-StrainQ32::kFracBits);
  if (gauges.noise_strain < step)
    throw Failure(
        ExitCode::kUsage,
        fmt::format("gauges.noise_strain = {} is below the firmware's step of strain; it must be at "
                    "least {:.3g}",
                    gauges.noise_strain, step));
  config::requireStrain(config, strainPerLoad);
  const double fullScale_n_per_m = gauges.full_scale_strain / strainPerLoad;
  const double largest = toReal(LineLoadQ12::max()),
               least = kLeastFullScale * powerOfTwo(-LineLoadQ12::kFracBits);
  if (!(fullScale_n_per_m >= least && fullScale_n_per_m <= largest))
    throw Failure(ExitCode::kUsage,
                  fmt::format("gauges.full_scale_strain = {} is a load of {:.3g} N/m on this finger; the "
                              "firmware's loads need one from {:.3g} to {:.3g} N/m: change it, "
                              "finger.shear_modulus_pa or gauges.radius_m",
                              gauges.full_scale_strain, fullScale_n_per_m, least, largest));
}

/// Second moments are whole um^2 and squares of widths 32 bits: widths are told from 0.1 to 65 mm.
constexpr double kNarrowest_m = 1e-4, kWidest_m = 65e-3;

void requireWidths(const config::Contact& contact) {
  if (contact.width_m) return;
  if (contact.largest_width_m >= kNarrowest_m && contact.largest_width_m <= kWidest_m) return;
  throw Failure(
      ExitCode::kUsage,
      fmt::format("contact.largest_width_m = {}: the firmware fits widths when it is from {} to {}; change "
                  "it, or say how wide contacts are in contact.width_m",
                  contact.largest_width_m, kNarrowest_m, kWidest_m));
}

/// Patches may be off the model by as much as readings are taken to be: by the model's error, by noise at
/// half of full scale, or by what the firmware's gates leave for the pressure's profile.
void requirePrecision(const config::FingerConfig& config, double interpolationError) {
  const double noise = 2 * config.gauges.noise_strain / config.gauges.full_scale_strain;
  const double profile = powerOfTwo(-firmware::threshold::kProfileErrorBits);
  const double allowed = std::hypot(config.gauges.model_error, noise, profile);
  if (interpolationError <= allowed) return;
  const config::Contact& contact = config.contact;
  const std::string width = contact.width_m
                                ? fmt::format("contact.width_m = {}", *contact.width_m)
                                : fmt::format("contact.width_m unknown up to contact.largest_width_m = {}",
                                              contact.largest_width_m);
  throw Failure(
      ExitCode::kUsage,
      fmt::format(
          "gauges.radius_m = {} is so near the surface at finger.outer_radius_m = {} that the tables are off "
          "by {:.2g} of a reading, with {}; noise and gauges.model_error = {} leave {:.2g}: move the gauges "
          "inwards, {}, or admit a larger gauges.model_error",
          config.gauges.radius_m, config.finger.outer_radius_m, interpolationError, width,
          config.gauges.model_error, allowed,
          contact.width_m ? "take contacts for narrower ones" : "cover less width or say what it is"));
}

TableParameters tableParameters(const config::FingerConfig& config) {
  constexpr double kUnknown = -1;
  return {.core_radius_m = config.finger.core_radius_m,
          .outer_radius_m = config.finger.outer_radius_m,
          .length_m = config.finger.length_m,
          .shear_modulus_pa = config.finger.shear_modulus_pa,
          .poisson_ratio = config.finger.poisson_ratio,
          .gauge_radius_m = config.gauges.radius_m,
          .first_angle_deg = config.gauges.first_angle_deg,
          .arc_length_m = config.gauges.arc_length_m,
          .noise_strain = config.gauges.noise_strain,
          .full_scale_strain = config.gauges.full_scale_strain,
          .model_error = config.gauges.model_error,
          .place_error_m = config.calibration.place_error_m,
          .load_error = config.calibration.load_error,
          .moment_error_m2 = config.calibration.moment_error_m2,
          .contact_width_m = config.contact.width_m.value_or(kUnknown),
          .largest_width_m = config.contact.largest_width_m,
          .friction_coefficient = config.contact.friction_coefficient,
          .gauge_count = static_cast<std::uint16_t>(config.gauges.count),
          .component = config.gauges.component,
          .adc_bits = static_cast<std::uint8_t>(config.gauges.adc_bits),
          .reserved = 0};
}

/// By the drawing and what calibration found; 0 beyond the ring.
GaugeAngles gaugeAngles_q32(const config::FingerConfig& config) {
  GaugeAngles angles_q32{};
  for (int gauge = 0; gauge < config.gauges.count; ++gauge)
    angles_q32[static_cast<std::size_t>(gauge)] = turnOf(config.calibrated(gauge).angle_rad);
  return angles_q32;
}

}  // namespace

TableImage buildTableImage(const config::FingerConfig& config) {
  requireWidths(config.contact);
  const DepthFit depths = depthFit(config);
  const ResponseTable responses = responseTable(config, depths.growth);
  requireFormats(config, responses.strainPerUnit);
  requirePrecision(config, responses.interpolationError);
  TableImage image{};
  image.magic = kTableMagic;
  image.format = kTableFormat;
  image.image_bytes = sizeof(TableImage);
  image.parameters = tableParameters(config);
  image.gains = gaugeGains(config, depths);
  image.depths = gaugeDepths(depths, responses);
  image.constants =
      tableConstants(config, image.gains, responses, depthError(config, depths, image.depths, responses));
  fillMoments(image.constants, config, responses);
  image.gauge_angle_q32 = gaugeAngles_q32(config);
  image.constants.reach_q32 = reach_q32(gapsOf(image.gauge_angle_q32, image.constants.gauge_count));
  std::copy(responses.patches.begin(), responses.patches.end(), image.patches.begin());
  image.crc32 = crc32(checkedBytes(image));
  return image;
}

}  // namespace strainfinger::tables
