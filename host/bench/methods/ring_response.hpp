#pragma once
// The elastic model as a table that every method with a slope reads.

#include "host/bench/methods/sample.hpp"

namespace strainfinger::bench {

/// What a gauge reads per N/m, and its derivative by the distance to the contact in pitches.
template <typename Real>
struct Response {
  Real normal, normalSlope;
  Real tangential, tangentialSlope;
};

/// A revolution of it. Cubic Hermite between the points: error below 1e-5 of the peak (RingResponseTest), so
/// that no method is limited by it. 8 KiB in float.
template <typename Real>
struct RingResponse {
  static constexpr int kPerPitch = 32;
  static constexpr int kPoints = kPerPitch * kGauges;

  std::array<Response<Real>, kPoints> points;  ///< at gauge - contact = i / kPerPitch pitches

  /// Of a gauge so many pitches beyond the contact. Domain: -2 to 2 revolutions.
  Response<Real> at(Real pitches) const {
    const Real place = pitches * kPerPitch + 2 * kPoints;  // positive, so that truncation is floor
    const int below = static_cast<int>(place);
    const Real part = place - static_cast<Real>(below);
    const auto& a = points[static_cast<unsigned>(below) % kPoints];
    const auto& b = points[static_cast<unsigned>(below + 1) % kPoints];
    const Cubic normal = between(a.normal, a.normalSlope, b.normal, b.normalSlope, part);
    const Cubic tangential = between(a.tangential, a.tangentialSlope, b.tangential, b.tangentialSlope, part);
    return {normal.value, normal.slope, tangential.value, tangential.slope};
  }

 private:
  struct Cubic {
    Real value, slope;
  };
  static Cubic between(Real a, Real slopeA, Real b, Real slopeB, Real part) {
    constexpr Real kSpacing = Real{1} / kPerPitch;
    const Real da = slopeA * kSpacing, db = slopeB * kSpacing, rise = b - a;
    const Real third = da + db - 2 * rise, second = rise - da - third;
    return {a + part * (da + part * (second + part * third)),
            (da + part * (2 * second + 3 * part * third)) * kPerPitch};
  }
};

}  // namespace strainfinger::bench
