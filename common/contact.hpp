#pragma once
// What is known of a touch.

#include <cstdint>

#include "common/quantities.hpp"

namespace strainfinger {

/// One contact with its standard errors. Angles counter-clockwise seen from the tip; normal load positive
/// when pressing, tangential positive towards increasing angle. Values saturate at the ends of their formats.
struct Contact {
  TurnQ32 angle;
  TurnQ32 sigmaAngle;  ///< at most half a revolution
  LineLoadQ12 normal;
  LineLoadQ12 sigmaNormal;
  LineLoadQ12 tangential;
  LineLoadQ12 sigmaTangential;
  TurnQ32 alternative;       ///< angle of another answer; meaningful when ambiguous
  std::uint8_t quality = 0;  ///< percent: 100 when one contact explains the readings within noise
  bool ambiguous = false;    ///< two answers within noise of each other: the errors cover both
  bool uncertain = false;    ///< quality 20 or less: ambiguous, not settled, or much left unexplained
};

}  // namespace strainfinger
