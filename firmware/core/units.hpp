#pragma once
// From a fit's units to those of contacts, and from those to the integers of frames.

#include "firmware/core/integers.hpp"

namespace strainfinger::firmware {

/// amplitude * scale * 2^exponent [LineLoadQ12], rounded to nearest, saturating. The exponent is below 0: see
/// usableLoads().
inline Number lineLoad(Number amplitude, Number scale, int exponent) {
  if (exponent <= -63) return 0;
  return saturate<Number>((Wide{amplitude} * scale + (Wide{1} << (-exponent - 1))) >> -exponent);
}

/// An angle [revolutions * 2^32] in hundredths of a degree, 0 .. 36000, rounded to nearest.
inline Natural centidegrees(Natural turns_q32) { return (turns_q32 * 36000 + (Natural{1} << 31)) >> 32; }

/// A difference of angles [revolutions * 2^32] in degrees, rounded to nearest.
inline Number wholeDegrees(Number turns_q32) {
  return Number((Wide{turns_q32} * 360 + (Wide{1} << 31)) >> 32);
}

/// Force of a line load [mN * 2^halvings], rounded to nearest; `perLoad_q16` [mN per N/m * 2^16] of 32 bits.
inline Wide force(Wide perLoad_q16, Number load_q12, int halvings) {
  const int down = 16 + 12 - halvings;
  return (Wide{load_q12} * perLoad_q16 + (Wide{1} << (down - 1))) >> down;
}

}  // namespace strainfinger::firmware
