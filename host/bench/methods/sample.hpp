#pragma once
// What every locator of the benchmark is given, and what it gives back. The headers of this folder are
// compiled for this machine and for the emulated processors alike: no heap, no files, nothing of the host's.

#include <array>
#include <cstdint>
#include <limits>

namespace strainfinger::bench {

inline constexpr int kGauges = 16;  ///< of the default finger

/// One strain a gauge.
template <typename Real>
using Ring = std::array<Real, kGauges>;

/// One conditioned sample set in the format that each kind of locator wants: nobody's conversion is counted.
struct Sample {
  Ring<std::int32_t> strain_q32;  ///< StrainQ32
  Ring<float> strain;             ///< the same
};

/// A line contact.
template <typename Real>
struct Place {
  Real position_pitch;  ///< from gauge 0; in any revolution
  Real normal;          ///< [N/m]; NaN from a method that doesn't tell
  Real tangential;      ///< [N/m], likewise
};

template <typename Real>
constexpr Place<Real> placeWithoutLoads(Real position_pitch) {
  constexpr Real kUntold = std::numeric_limits<Real>::quiet_NaN();
  return {position_pitch, kUntold, kUntold};
}

/// The gauge with this number, from any revolution.
constexpr std::size_t gaugeOf(int number) {
  static_assert((kGauges & (kGauges - 1)) == 0);
  return static_cast<std::size_t>(number & (kGauges - 1));
}

}  // namespace strainfinger::bench
