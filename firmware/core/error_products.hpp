#pragma once
// The arithmetic of the standard errors: products and roots, no decisions. `noise` is the variance of a
// reading, as an energy of the fit.

#include <algorithm>
#include <array>
#include <limits>

#include "firmware/core/scaled.hpp"
#include "firmware/core/triple_step.hpp"
#include "firmware/core/wide.hpp"

namespace strainfinger::firmware {

/// Deviations are brought within +-2^this: with a covariance of up to 2^13 * 2^12, which is what invert()
/// lets through, their quadratic form then fits, whatever their signs.
inline constexpr int kDeviationBits = 17;
inline constexpr int kCovarianceBits = 25;

/// Of the offset [pitches * 2^20]: noise over the information in the gradient.
[[gnu::noinline]] inline Number offsetSigma(Scaled noise, Number information, int gradientExponent) {
  if (information <= 0) return kOnePitch;
  const int up = leadingZeros(information) - 16;
  const Number digits = up >= 0 ? raised(information, up) : information >> -up;
  return root({(noise.mantissa << 7) / Natural(digits),
               noise.exponent + up - 2 * (gradientExponent + 1) - 7 + 2 * kPitchBits});
}

/// What an error of the offset adds to that of an amplitude with so much slope per row spacing.
inline Wide carriedOver(Number slope, Number offset_sigma) {
  return (Wide{slope} * offset_sigma) >> kRowBits;
}

/// Of an amplitude: its own at a known offset, of projections times `gains`, and what the offset's error
/// adds.
[[gnu::noinline]] inline Number amplitudeSigma(Scaled noise, const std::array<Number, 2>& gains, Number slope,
                                               Number offset_sigma) {
  const Natural gainSquared = shortSquare(gains[0]) + shortSquare(gains[1]);
  const Wide carried = limited(carriedOver(slope, offset_sigma), Wide{1} << 30);
  return root({plain({noise.mantissa * gainSquared, noise.exponent}) + squared(carried), 0});
}

/// Standard errors of an amplitude along the three directions in which a contact moves the readings, were
/// these told by all gauges: by its loads' coefficients, and carried over from the offset.
using Deviations = std::array<Wide, 3>;
inline Deviations deviationsOf(Scaled noise, const std::array<Number, 2>& gains, Number slope,
                               Number offset_sigma) {
  const Wide deviation = root({noise.mantissa, noise.exponent + 16});
  return {(deviation * gains[0]) >> 8, (deviation * gains[1]) >> 8, carriedOver(slope, offset_sigma)};
}

/// d C d, with C symmetric: 11, 12, 13, 22, 23, 33.
inline Wide quadraticForm(const Deviations& d, const std::array<Number, 6>& c) {
  return d[0] * d[0] * c[0] + d[1] * d[1] * c[3] + d[2] * d[2] * c[5] +
         (d[0] * d[1] * c[1] + d[0] * d[2] * c[2] + d[1] * d[2] * c[4]) * 2;
}

/// The root of d C d, with C what the remaining gauges tell of the three (Fit::covariance_q12).
[[gnu::noinline]] inline Number reducedSigma(Deviations d, const std::array<Number, 6>& covariance_q12) {
  Natural largest = 0;
  for (const Wide& each : d) largest = larger(largest, sizeOf(each));
  const int down = std::max(64 - leadingZeros(largest) - kDeviationBits, 0);
  for (Wide& each : d) each = noLarger(each, largest) >> down;
  return root({positivePart(quadraticForm(d, covariance_q12)), 2 * down - 12});
}

/// What one of three readings weighs in an amplitude, times the system's volume: through the projections, at
/// `load` per each, and through the offset, at `slope` per row spacing. Over 2^14.
inline Wide amplitudeWeight(const FitRow& row, const TripleSystem& system, std::size_t reading,
                            const std::array<Number, 2>& load, Number slope) {
  const Wide own =
      Wide{load[0]} * system.forProjection1[reading] + Wide{load[1]} * system.forProjection2[reading];
  const Wide carried = Wide{slope} * system.forOffset[reading] * kRowsPerPitch;
  return own * (1 << 14) + (carried >> (row.gradient_exponent + 3)) * 8;
}

/// Of a sum of three readings, each times weight * 2^weightExponent / volume.
[[gnu::noinline]] inline Number weightedSigma(Scaled noise, const Vector3& weights, int weightExponent,
                                              Number volume) {
  if (volume == 0) return std::numeric_limits<std::int32_t>::max();
  Natural square = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) square = square + squared(Wide{weights[i]});
  const Scaled above = normalised(square);
  const Scaled below = normalised(squared(Wide{volume}));
  // A reading's variance is four times its energy.
  return root({noise.mantissa * above.mantissa / below.mantissa,
               noise.exponent + 2 + above.exponent - below.exponent + 2 * weightExponent});
}

}  // namespace strainfinger::firmware
