#pragma once
// The arithmetic of fits to the gauges that are not left out (left_out.hpp): all that could leave its
// word, no decisions.

#include "firmware/core/energies.hpp"
#include "firmware/core/fit_step.hpp"
#include "firmware/core/tangent_products.hpp"

namespace strainfinger::firmware {

/// Rounding makes two fits differ by this part of their energy, as a power of two.
inline constexpr int kAmbiguousShift = 17;

/// Energies of a window that lacks some gauges.
struct WindowEnergies {
  Number read;         ///< of its readings, the outer pair's included
  Number missing = 0;  ///< what those left out should have

  void add(Number reading) { read += energyOf(reading); }
  void addMissing(Number predicted) { missing += energyOf(clipped<16>(predicted)); }
  /// Of the ring's energy, what is outside and a contact in the window may well have left there.
  Number outside(Number ringEnergy, Number tail_q16) const {
    const Number most = mostOutside(read + oneBeside(read, missing), tail_q16);
    return atMost(atLeast(ringEnergy - read, 0), most);
  }
};

/// Amplitudes as locate() has them, at a row; saturating.
inline Amplitudes amplitudesAt(const FitRow& row, int side, const Three& coefficients) {
  constexpr int kDown = 5;  // from coefficients * 2^4 to projections * 2^15, then as scaledBy() in window_fit
  const Wide normal =
      Wide{tabled(row.load[0])} * coefficients[0] + Wide{tabled(row.load[1])} * coefficients[1];
  const Wide tangential = Wide{tabled(row.load[2])} * coefficients[1];
  return {saturated(normal >> kDown), saturated((tangential >> kDown) * side)};
}

/// How far within the friction cone loads are; below 0: beyond it.
inline Wide insideCone(const Amplitudes& loads, Number friction_cone_q8) {
  return Wide{loads.normal} * friction_cone_q8 - Wide(sizeOf(loads.tangential)) * 256;
}

/// What another answer must explain more than, not to be told apart from one that explains so much.
inline Wide leastOfRivals(Number explained, Number ambiguous) {
  return Wide{explained} - ambiguous - (explained >> kAmbiguousShift);
}

}  // namespace strainfinger::firmware
