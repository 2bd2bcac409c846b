#pragma once
// The fit of the three readings around the deepest one, from where the pairs beside it tell the contact to
// be.

#include <cstdint>

#include "firmware/core/locate.hpp"

namespace strainfinger::firmware {

/// The paper's fit, judged by all seven readings of the window, of strains as locate() takes them. False, and
/// nothing is answered: the contact is not firm, too far from a gauge, or one that three readings hardly
/// tell. Bounded time: three pairs of near rows, and one row of the fit.
bool locateByNearest(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32,
                     std::uint32_t energy);

}  // namespace strainfinger::firmware
