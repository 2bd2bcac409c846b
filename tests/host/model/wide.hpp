#pragma once
// Numbers of 100 digits. Costly to compile: only what needs all the digits includes this.

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>

#include "host/model/harmonic.hpp"

namespace strainfinger::testing {

using Wide =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;
using WideAnnulus = model::Annulus<Wide>;
using WideResponse = model::HarmonicResponse<Wide>;

/// A double annulus, its numbers taken as exact.
inline WideAnnulus widen(const model::Annulus<double>& annulus) {
  return {annulus.core_radius_m, annulus.outer_radius_m, annulus.shear_modulus_pa, annulus.poisson_ratio};
}

/// cos and sin of 0, x, 2 x, ... by rotation: 100 digits have room for its errors.
struct Multiples {
  explicit Multiples(const Wide& angle) : x(angle), cosine(cos(angle)), sine(sin(angle)) {}
  void advance() {
    const Wide next = c * cosine - s * sine;
    s = s * cosine + c * sine;
    c = next;
    phase += x;
  }
  /// Of cos over the phases from -phase to phase.
  Wide mean() const { return phase == 0 ? Wide(1) : Wide(s / phase); }

  Wide x, cosine, sine;
  Wide c = 1, s = 0, phase = 0;
};

/// The oracle of michell_oracle.hpp with all its digits.
WideResponse michellResponse(const WideAnnulus& finger, const Wide& radius_m, int n);

}  // namespace strainfinger::testing
