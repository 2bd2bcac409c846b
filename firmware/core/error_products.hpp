#pragma once
// The long products behind the standard errors of fits that rest on fewer than all seven gauges.

#include <array>

#include "firmware/core/triple_step.hpp"
#include "firmware/core/wide.hpp"

namespace strainfinger::firmware {

/// Deviations are brought within +-2^this: with a covariance of up to 2^13 * 2^12, which is what invert()
/// lets through, their quadratic form then fits, whatever their signs.
inline constexpr int kDeviationBits = 17;
inline constexpr int kCovarianceBits = 25;

/// d C d, with C symmetric: 11, 12, 13, 22, 23, 33.
inline Wide quadraticForm(const std::array<Wide, 3>& d, const std::array<Number, 6>& c) {
  return d[0] * d[0] * c[0] + d[1] * d[1] * c[3] + d[2] * d[2] * c[5] +
         (d[0] * d[1] * c[1] + d[0] * d[2] * c[2] + d[1] * d[2] * c[4]) * 2;
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

}  // namespace strainfinger::firmware
