#pragma once
// The arithmetic of whether a gauge is to be trusted (gauge_watch.hpp, pipeline.hpp), most of it
// leave-one-out prediction: all that could leave its word, no decisions.

#include <cstdint>

#include "firmware/core/energies.hpp"

namespace strainfinger::firmware {

/// So much noise and that part of an energy, as a power of two.
inline Number noiseAndPart(Number noise, Number energy, int shift) { return noise + (energy >> shift); }

/// What is outside a window beyond what a contact in it may leave there.
inline Number excessOutside(Number outside, Number window, Number tail_q16) {
  return atLeast(outside - mostOutside(window, tail_q16), 0);
}

/// What is left of a ring's energy; less than nothing is explained by none.
inline Number leftOf(Number ringEnergy, Number explained) {
  return atLeast(ringEnergy - atLeast(explained, 0), 0);
}

/// With which a culprit is not told apart from one that leaves so much unexplained.
inline Number mostLikeIt(Number unexplained, Number told) { return unexplained + (unexplained >> 2) + told; }

/// Energies of a ring about a window, and the largest of each.
struct Split {
  Number window = 0, outside = 0;
  Number largestInside = 0, largestOutside = 0;

  void addInside(Number energy) {
    window += energy;
    largestInside = atLeast(energy, largestInside);
  }
  void addOutside(Number energy) {
    outside += energy;
    largestOutside = atLeast(energy, largestOutside);
  }
  /// What a contact of this window leaves unexplained at least, if one gauge of each part is left out: it
  /// leaves that part of its energy outside, as a power of two.
  Number leastUnexplained(int tailShift) const {
    return outside - largestOutside - ((window - largestInside) >> tailShift);
  }
};

/// A reading with residual r and leverage h, left out.
struct LeftOut {
  Number relief;   ///< what that takes off the unexplained energy: r^2 / (1 - h), saturating
  Number reading;  ///< what the others say that it should be: itself - r / (1 - h), saturating at 16 bits
};
[[gnu::noinline]] inline LeftOut leftOut(Number reading, Number difference, Number leverage_q15) {
  constexpr std::int32_t kMost = 1 << 24;  // from 2^17 on, both results saturate
  const Wide residual = atMost(atLeast(difference, -kMost), kMost);
  const Number left = atLeast((1 << 15) - leverage_q15, 1 << 9);
  return {saturated((residual * residual << 13) / left), shortened(Wide{reading} - (residual << 15) / left)};
}

/// What a contact leaves unexplained of a ring without one of its gauges.
struct Unexplained {
  Wide inside;     ///< of the window's readings
  Number outside;  ///< energy of the readings outside ..
  Number trusted;  ///< .. and inside, that the contact may have left so much outside

  void leaveOutside(Number energy) { outside -= energy; }
  /// Of the window, as leftOut() has it.
  void leaveInside(Number reading, const LeftOut& without) {
    inside -= without.relief;
    trusted = atLeast(trusted - energyOf(reading), 0);
    trusted += oneBeside(trusted, energyOf(without.reading));
  }
  /// The outer pair's difference: what the gauge that is left reads is then outside.
  void leaveOuter(Number energy, const LeftOut& without) {
    inside -= without.relief;
    outside += energy;
    trusted -= energy;
  }
  /// Saturating.
  Number energy(Number tail_q16) const {
    return saturated(Wide(positivePart(inside)) + excessOutside(outside, trusted, tail_q16));
  }
};

/// Above 0: a reading is off what it should be by more than half of that.
inline Number farOff(Number reading, Number expected) {
  return absolute(reading - expected) * 2 - absolute(expected);
}

/// By how much a strain jumps.
inline Number jumpOf(Number strain_q32, Number before_q32) { return absolute(strain_q32 - before_q32); }

/// A strain's part of gateEnergy().
inline Number gatePart(Number strain_q32, int gateShift) { return squareOfShort(strain_q32 >> gateShift); }

/// A gauge at a rail is where it should be if the others predict more than this.
inline Number leastAtRail(Number rail_q32) { return Number(Wide{rail_q32} * 3 / 4); }

/// A gauge out of use is judged where it should have at least a sixteenth of the ring's energy (the gate's):
/// where this is no less than that.
inline Wide muchOf(Number gatePart) { return Wide{gatePart} * 16; }
/// Below 0: a gauge reads what the others predict, within an eighth.
inline Wide offBy(Number measured_q32, Number predicted_q32) {
  return Wide{absolute(measured_q32 - predicted_q32)} * 8 - absolute(predicted_q32);
}

}  // namespace strainfinger::firmware
