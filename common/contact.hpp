#pragma once
// What is known of a touch.

#include <cstdint>
#include <limits>

#include "common/quantities.hpp"

namespace strainfinger {

/// A width, and its sigma, of a contact whose width was not fitted: known beforehand, or beyond what the
/// readings can tell.
inline constexpr std::uint32_t kWidthNotFitted = std::numeric_limits<std::uint32_t>::max();
/// A chi of a fit without a degree of freedom left.
inline constexpr std::uint16_t kNoChi = std::numeric_limits<std::uint16_t>::max();

/// One contact with its standard errors. Angles counter-clockwise seen from the tip; normal load positive
/// when pressing, tangential positive towards increasing angle. Values saturate at the ends of their formats.
struct Contact {
  TurnQ32 angle;
  TurnQ32 sigmaAngle;  ///< at most half a revolution
  LineLoadQ12 normal;
  LineLoadQ12 sigmaNormal;
  LineLoadQ12 tangential;
  LineLoadQ12 sigmaTangential;
  std::uint32_t width_um = kWidthNotFitted;  ///< of the uniform pressure with the same second moment
  std::uint32_t sigmaWidth_um = kWidthNotFitted;
  std::uint16_t chi_q4 = kNoChi;  ///< root of chi-squared per degree of freedom: 16 is noise alone
  TurnQ32 alternative;            ///< angle of another answer; meaningful when ambiguous
  std::uint8_t quality = 0;       ///< percent: 100 when the contacts explain the readings within the gate
  bool ambiguous = false;         ///< another place fits nearly as well: the errors cover both
  bool uncertain = false;         ///< quality 20 or less: ambiguous, not settled, or much left unexplained
};

}  // namespace strainfinger
