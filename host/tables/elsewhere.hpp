#pragma once
// What else could be taken for a contact.

#include "host/model/impulse_response.hpp"

namespace strainfinger::tables {

/// The least part of a ring's energy that a fit at another offset of a window leaves unexplained, with loads
/// a little beyond `cone` (largest |tangential| / normal). The window is that of the deepest reading, the
/// contacts are all that are a quarter of a pitch or more from its gauge (nearer ones have a second look),
/// but those that leave too much outside the window to be believed there. For radial and hoop strains, which
/// look the same in a mirror. Cost: the responses of a ring at 81 places and of a window at 162, and 81 fits
/// at each of the 81 places.
double leastElsewhere(const model::ImpulseResponse& response, int gaugeCount, double cone);

/// As TableConstants::firm_exponent, not limited to what it may be, of that part.
int firmExponent(double leastLeft);

}  // namespace strainfinger::tables
