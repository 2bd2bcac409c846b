#pragma once
// Where around the ring there are touches. A ring has two arcs a gauge, counter-clockwise: arc 2 i is over
// gauge i, a quarter of the gaps to either side; arc 2 i + 1 is between gauge i and the next.

#include <string>
#include <vector>

#include "host/calibration/touch_fit.hpp"
#include "host/config/finger_config.hpp"
#include "host/session/rows.hpp"

namespace strainfinger::session {

int arcOf(const config::Gauges& gauges, double place_rad);

/// The middle of an arc, 0 .. 2 pi.
double middleOf_rad(const config::Gauges& gauges, int arc);

/// Neighbours along the ring: `count` arcs from `first` on.
struct ArcRun {
  int first = 0;
  int count = 0;
  bool operator==(const ArcRun&) const = default;
};

/// The longest run of arcs for which `wanted` is true; an empty one if there is none.
ArcRun longestRun(const std::vector<bool>& wanted);

/// "over gauge 6 (135 deg)", "between gauges 5 and 6 (112 to 135 deg)", "from gauge 3 to gauge 6 (68 to 135
/// deg)", "all around".
std::string nameOf(const config::Gauges& gauges, const ArcRun& run);

/// What is known of touches, and where they are.
struct Coverage {
  std::vector<int> touches;  ///< an arc
  int untouched = 0;
  int loads = 0;                       ///< known ones
  std::vector<double> directions_deg;  ///< known ones
};

Coverage coverageOf(const config::Gauges& gauges, const calibration::TouchSearch& search, const Rows& rows);

/// Counts one more row.
void count(Coverage& coverage, const config::Gauges& gauges, const calibration::TouchSearch& search,
           const Eigen::VectorXd& strains, const calibration::KnownTouch& known);

}  // namespace strainfinger::session
