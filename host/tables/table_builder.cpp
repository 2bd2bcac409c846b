#include "host/tables/table_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/fixed_real.hpp"
#include "host/base/failure.hpp"
#include "host/config/keys.hpp"
#include "host/model/impulse_response.hpp"
#include "host/tables/elsewhere.hpp"
#include "host/tables/fit_table.hpp"
#include "host/tables/gauge_gains.hpp"
#include "host/tables/near_table.hpp"
#include "host/tables/pressed_ring.hpp"
#include "host/tables/scan_spans.hpp"
#include "host/tables/start_weights.hpp"
#include "host/tables/tail_energy.hpp"

namespace strainfinger::tables {
namespace {

/// Fits may come out of the friction cone by noise: this factor times the coefficient is allowed.
constexpr double kConeMargin = 1.25;
/// Noise alone makes a load without friction look like one with a coefficient of this.
constexpr double kLeastCone = 0.1;

double frictionCone(const config::Contact& contact) {
  return std::max(kConeMargin * contact.friction_coefficient, kLeastCone);
}

/// Sum of `count` squared unit normal variates that one sample in a billion (z = 6.0) or in a thousand
/// (z = 3.09) exceeds: Wilson & Hilferty (1931), good to 4 % here.
double chiSquareQuantile(int count, double z) {
  const double spread = 2.0 / (9.0 * count);
  return count * std::pow(1 - spread + z * std::sqrt(spread), 3);
}

/// Steps of load that a full scale must have at least, for errors of a few per thousand.
constexpr double kLeastFullScale = 1024;

struct MantissaExponent {
  double mantissa;  ///< in [2^(bits-1), 2^bits)
  int exponent;
};
MantissaExponent normalised(double value, int bits) {
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  return {std::ldexp(fraction, bits), exponent - bits};
}

std::uint32_t rounded(double value) { return saturate<std::uint32_t>(std::llround(value)); }

/// The gate's strains are rounded down: that adds up to one of its steps to a reading, with a mean square of
/// 1/3, and of 1/2 where the noise is much smaller than a step.
constexpr double kGateRounding = 0.5;

void fillNoise(TableConstants& constants, double noise_q32, double fullScale_q32) {
  // The converter spans 2 full scales and the zero may lie anywhere in it: usableGain(), with 1 for rounding.
  constants.gate_shift =
      static_cast<std::uint8_t>(std::max(0.0, std::ceil(std::log2(4 * fullScale_q32 + 3)) - 16));
  const auto variance = normalised(noise_q32 * noise_q32, 24);
  constants.noise_variance = rounded(variance.mantissa);
  constants.noise_variance_exponent = static_cast<std::int8_t>(variance.exponent);
  const double noiseInGate = std::ldexp(noise_q32, -constants.gate_shift);
  const double gateVariance = noiseInGate * noiseInGate + kGateRounding;
  const auto gate = [&](double z) {
    return rounded(chiSquareQuantile(constants.gauge_count, z) * gateVariance);
  };
  constants.gate_on = gate(6.0);
  constants.gate_off = gate(3.09);
}

/// A fit's amplitudes are strains at the peak * 2^32 * 2^(amplitude_exponent - 1).
void fillLoads(TableConstants& constants, double peak, int amplitudeExponent) {
  const auto load =
      normalised(std::ldexp(1 / peak, LineLoadQ12::kFracBits - 32 - (amplitudeExponent - 1)), 31);
  constants.load_scale = saturate<std::int32_t>(std::llround(load.mantissa));
  constants.load_exponent = static_cast<std::int16_t>(load.exponent);
  constants.amplitude_exponent = static_cast<std::int8_t>(amplitudeExponent);
}

/// Where fits don't see the exact place, and gains are off by a few percent.
constexpr double kTailMargin = 1.25;

std::uint16_t tail_q16(double tail) {
  return saturate<std::uint16_t>(std::llround(std::ldexp(kTailMargin * tail, 16)));
}

/// Rings of 16 and more see a single peak over the contact, about a pitch wide. Coarser rings, and shear,
/// whose response has two, are searched everywhere and twice as finely.
bool hasOnePeak(const config::Gauges& gauges) {
  return gauges.count >= 16 && gauges.component != StrainComponent::kShear;
}

/// What correcting gains makes of the noise, as an RMS, and of the largest full scale.
struct Corrected {
  double noise_strain;
  double full_scale_strain;
};

Corrected corrected(const config::FingerConfig& config) {
  const auto factors = correctionFactors(gaugeGains(config), config.gauges.count);
  double squares = 0, largest = 1;  // gauges beyond the ring have a factor of 1
  for (const double factor : factors) {
    squares += factor * factor;
    largest = std::max(largest, factor);
  }
  return {config.gauges.noise_strain * std::sqrt(squares / config.gauges.count),
          config.gauges.full_scale_strain * largest};
}

TableConstants tableConstants(const config::FingerConfig& config, bool peakIsNegative) {
  TableConstants constants{};
  constants.gauge_count = static_cast<std::uint8_t>(config.gauges.count);
  constants.pitch_turn_q35 = rounded(powerOfTwo(35) / config.gauges.count);
  const double turns = config.gauges.first_angle_deg / 360;
  constants.first_angle_q32 = fromReal<TurnQ32>(turns - std::floor(turns)).raw();
  const Corrected ring = corrected(config);
  fillNoise(constants, ring.noise_strain * powerOfTwo(32), ring.full_scale_strain * powerOfTwo(32));
  constants.reading_gain =
      static_cast<std::int32_t>(rounded(config.gauges.full_scale_strain * powerOfTwo(34)));
  constants.force_per_load_q16 = rounded(config.finger.length_m * 1000 * powerOfTwo(16));
  constants.friction_cone_q8 = saturate<std::uint16_t>(std::llround(frictionCone(config.contact) * 256));
  constants.adc_rail = static_cast<std::uint16_t>(0xFFFF << (16 - config.gauges.adc_bits));
  constants.mirror_sign = config.gauges.component == StrainComponent::kShear ? -1 : 1;
  constants.anchor_sign = peakIsNegative ? 1 : -1;
  constants.anchor_rule = AnchorRule::kSecondDifference;
  constants.scan_step = kMaxScanStep;
  constants.firm_exponent = kMostFirmExponent;
  return constants;
}

/// No start is told where however firm a contact another place explains it.
void fillStart(TableImage& image, const model::ImpulseResponse& response, int gaugeCount, double cone) {
  const int exponent = firmExponent(leastElsewhere(response, gaugeCount, cone));
  if (exponent > kMostFirmExponent) return;
  image.constants.firm_exponent = static_cast<std::uint8_t>(std::max(exponent, kLeastFirmExponent));
  image.start = startWeights(response, gaugeCount, cone);
}

/// Of the strain at the gauges to load / (shear modulus * radius): that of usual gauges is about one, what
/// rounding leaves of none at all 1e-16.
constexpr double kLeastResponse = 1e-12;

/// Readings and loads must fit the firmware's integers.
void requireFormats(const config::FingerConfig& config, double peak) {
  const config::Gauges& gauges = config.gauges;
  const double step = powerOfTwo(-StrainQ32::kFracBits);
  if (gauges.noise_strain < step)
    throw Failure(
        ExitCode::kUsage,
        fmt::format("gauges.noise_strain = {} is below the firmware's step of strain; it must be at "
                    "least {:.3g}",
                    gauges.noise_strain, step));
  if (peak * config.finger.shear_modulus_pa * config.finger.outer_radius_m < kLeastResponse)
    throw Failure(
        ExitCode::kUsage,
        fmt::format("gauges.radius_m = {} is where the rubber has no {} strain, on the core "
                    "(finger.core_radius_m = {}): move the gauges outwards, or read another "
                    "gauges.component",
                    gauges.radius_m, config::componentName(gauges.component), config.finger.core_radius_m));
  const double fullScale_n_per_m = gauges.full_scale_strain / peak;
  const double largest = toReal(LineLoadQ12::max()),
               least = kLeastFullScale * powerOfTwo(-LineLoadQ12::kFracBits);
  if (!(fullScale_n_per_m >= least && fullScale_n_per_m <= largest))
    throw Failure(ExitCode::kUsage,
                  fmt::format("gauges.full_scale_strain = {} is a load of {:.3g} N/m on this finger; the "
                              "firmware's loads need one from {:.3g} to {:.3g} N/m: change it, "
                              "finger.shear_modulus_pa or gauges.radius_m",
                              gauges.full_scale_strain, fullScale_n_per_m, least, largest));
}

}  // namespace

TableParameters tableParameters(const config::FingerConfig& config) {
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
          .contact_width_m = config.contact.width_m.value_or(0),
          .friction_coefficient = config.contact.friction_coefficient,
          .gauge_count = static_cast<std::uint16_t>(config.gauges.count),
          .component = config.gauges.component,
          .adc_bits = static_cast<std::uint8_t>(config.gauges.adc_bits),
          .reserved = 0};
}

TableImage buildTableImage(const config::FingerConfig& config) {
  const model::ImpulseResponse response(config.finger.annulus(), config.gauges.radius_m,
                                        config.gauges.component, config.gauges.arc_length_m,
                                        config.contact.width_m.value_or(0));
  const WindowResponses responses = windowResponses(response, config.gauges.count);
  const double peak = peakPerLoad(responses);
  requireFormats(config, peak);
  const double cone = frictionCone(config.contact);
  const WindowFits fits = windowFits(responses, peak, cone);
  TableImage image{};
  image.magic = kTableMagic;
  image.format = kTableFormat;
  image.image_bytes = sizeof(TableImage);
  image.parameters = tableParameters(config);
  image.constants = tableConstants(config, peakSign(response) < 0);
  const int exponent = amplitudeExponent(fits);
  fillLoads(image.constants, peak, exponent);
  image.constants.tail_q16 = tail_q16(tailEnergy(response, config.gauges.count, cone));
  image.constants.scan_span = scanSpans(response, config.gauges.count, cone);
  if (hasOnePeak(config.gauges)) fillStart(image, response, config.gauges.count, cone);
  image.rows = fitTable(fits, exponent);
  const double pole_pitch = nearPole(response, config.gauges.count);
  image.constants.near_pole_q15 = saturate<std::uint16_t>(std::llround(std::ldexp(pole_pitch, 15)));
  image.near = nearTable(responses, peak, exponent, pole_pitch);
  image.gains = gaugeGains(config);
  image.crc32 = crc32(checkedBytes(image));
  if (!hasOnePeak(config.gauges)) searchEverywhere(image);
  return image;
}

void searchEverywhere(TableImage& image) {
  image.constants.anchor_rule = AnchorRule::kExhaustive;
  image.constants.scan_step = kMinScanStep;
  image.start = {};
  image.crc32 = crc32(checkedBytes(image));
}

}  // namespace strainfinger::tables
