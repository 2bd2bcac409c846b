#pragma once
// What else could be taken for a contact.

#include "host/model/impulse_response.hpp"

namespace strainfinger::tables {

/// The least part of a window's energy that a fit at another offset of it leaves unexplained, with loads a
/// little beyond `cone` (largest |tangential| / normal). The window is that of the deepest reading, the
/// contacts are all that are a quarter of a pitch or more from its gauge (nearer ones have a second look),
/// but those that leave too much outside the window to be believed there. Cost: the responses of a ring at 81
/// places and of a window at 162, and 81 fits at each of those.
double leastElsewhere(const model::ImpulseResponse& response, int gaugeCount, double cone);

/// As TableConstants::firm_exponent, not limited to what it may be.
int firmExponent(double leastElsewhere);

}  // namespace strainfinger::tables
