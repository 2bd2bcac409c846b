#pragma once
// What fingers could tell, over the number of their gauges.

#include <array>
#include <vector>

#include "host/design/assessment.hpp"
#include "host/plot/picture.hpp"

namespace strainfinger::design {

/// A finger that was looked at.
struct Candidate {
  int gauges;
  double radius_m;  ///< of the ring
  Assessment found;
};

/// Worst bounds of place and normal load, a curve a radius; hollow where there is a problem.
/// `candidates`: at least one, those of a radius one after the other. Bounds that are infinite are gaps.
plot::Picture boundsPicture(const std::vector<Candidate>& candidates);

/// The name of its data file.
inline constexpr std::array kBoundsData{"fingers"};

}  // namespace strainfinger::design
