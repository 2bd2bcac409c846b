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
  TurnQ32 alternative;  ///< angle of another answer; meaningful when ambiguous
  std::uint8_t quality =
      0;  ///< percent: 100 when the readings fit within noise and only one way, at most 20 when ambiguous
  bool ambiguous = false;  ///< two answers within noise of each other; the errors cover both
};

}  // namespace strainfinger
