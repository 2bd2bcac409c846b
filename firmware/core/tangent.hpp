#pragma once
// What a contact can do to the readings of a window, to first order: how much each gauge weighs in the fit,
// and what the others say that it should read.

#include <array>
#include <cstdint>
#include <span>

#include "firmware/core/problem.hpp"
#include "firmware/core/tangent_products.hpp"

namespace strainfinger::firmware {

/// Bit i: gauge i.
using GaugeSet = std::uint32_t;
constexpr bool contains(GaugeSet set, int gauge) { return (set >> gauge & 1) != 0; }

/// The ring's strains as the problem scales them, rounded; gauges that are left out read 0. Scaled as they
/// are asked for: no copy on the stack.
struct RingSignal {
  const Problem& problem;
  GaugeSet leftOut;

  std::int16_t at(int gauge) const {
    if (contains(leftOut, gauge)) return 0;
    return scaledStrain(problem.strains[static_cast<std::size_t>(gauge)], problem.up);
  }
};

/// A window as seen from a contact: offset in rows from the middle gauge towards `side`.
struct View {
  int centre = 0;
  int side = 1;
  int row = 0;
};

/// The gauge at `step` of a view.
int gaugeAt(const Problem& problem, const View& view, int step);
View viewOf(const Problem& problem, PitchQ20 position);

/// Inverse [* 2^12] of a symmetric matrix [* 2^24] with elements up to 1, in its place if need be; false
/// where its determinant is next to nothing.
bool invert(const Symmetric& matrix_q24, Symmetric& inverse_q12);

/// Unit vectors at right angles in the space of a window's readings [* 2^15]: two that a contact reaches by
/// changing its loads, one by moving. A fit takes from the readings what lies along them, so
/// sum of squares over the three = leverage of a reading.
struct Tangent {
  std::array<Directions, kReadings> at{};  ///< by indexOf(step)
  /// Length of the change that a move of one pitch makes [signal * 2^6]; 0: moving changes nothing.
  std::int64_t steepness = 0;
};

/// What the readings that are not left out say: coefficients along the tangent [signal * 2^4].
struct Share {
  Three coefficients{};
  Symmetric covariance_q12{};    ///< of the coefficients, in variances of a reading; identity with all gauges
  std::int32_t explained = 0;    ///< energy (a quarter of the squared signal) of the window's readings left
  std::int32_t unexplained = 0;  ///< the rest of it, from the residuals: exact where it is small
  bool determined = false;       ///< enough gauges are left to tell where and how hard
  std::int16_t outer = 0;        ///< what is read at kOuterReach, as the view sees it

  std::int32_t outerEnergy() const { return energyOf(outer); }

  PitchQ20 beyondRow(const Tangent& tangent) const;
};

/// The fit at a view, linear about its row.
struct LocalFit {
  Tangent tangent;
  Share share;
  /// How much of its own reading the fit takes at `step` of the view.
  std::int32_t leverage_q15(int step) const;
  /// What the fit leaves of Share::outer.
  std::int32_t outerResidual() const;
  /// What should be read there [signal], and as a strain.
  std::int32_t predicted(const Problem& problem, const View& view, int step) const;
  std::int32_t predicted_q32(const Problem& problem, const View& view, int step) const;
  /// What the gauge at `step` (- fitReach() .. fitReach()) should read, as a strain. Of the outer pair: as
  /// the other one reads; half of the difference if that one is left out, too.
  std::int32_t expected_q32(const Problem& problem, const RingSignal& signal, const View& view,
                            int step) const;
};
LocalFit localFit(const Problem& problem, const RingSignal& signal, const View& view);

/// Energy that a contact at a view explains of the readings left, at its best loads; -1: not determined.
std::int32_t explainedAt(const Problem& problem, const RingSignal& signal, const View& view);

}  // namespace strainfinger::firmware
