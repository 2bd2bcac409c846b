#include "host/session/coverage.hpp"

#include <fmt/format.h>

#include "host/base/angles.hpp"

namespace strainfinger::session {
namespace {

/// Of the ring: longer runs have no ends that are worth naming.
constexpr double kMostArcsNamed = 0.75;

}  // namespace

int arcOf(const config::Gauges& gauges, double place_rad) {
  const double place_deg = degreesOf(place_rad);
  for (int gauge = 0; gauge < gauges.count; ++gauge) {
    const double behind_deg = withinATurn_deg(place_deg - gauges.angle_deg(gauge));
    const double gap_deg = gauges.gap_deg(gauge);
    if (behind_deg >= gap_deg) continue;
    if (behind_deg < gap_deg / 4) return 2 * gauge;
    return behind_deg < gap_deg * 3 / 4 ? 2 * gauge + 1 : (2 * gauge + 2) % (2 * gauges.count);
  }
  return 0;  // a place that rounding put upon the first gauge
}

double middleOf_rad(const config::Gauges& gauges, int arc) {
  const int gauge = arc / 2;
  const double into_deg = arc % 2 == 0 ? 0 : gauges.gap_deg(gauge) / 2;
  return withinATurn_deg(gauges.angle_deg(gauge) + into_deg) * kRadPerDeg;
}

ArcRun longestRun(const std::vector<bool>& wanted) {
  const int arcs = static_cast<int>(wanted.size());
  ArcRun best;
  for (int first = 0; first < arcs; ++first) {
    int length = 0;
    while (length < arcs && wanted[static_cast<std::size_t>((first + length) % arcs)]) ++length;
    if (length > best.count) best = {first, length};
  }
  return best;
}

std::string nameOf(const config::Gauges& gauges, const ArcRun& run) {
  const int arcs = 2 * gauges.count;
  if (run.count > kMostArcsNamed * arcs) return "all around";
  const int last = (run.first + run.count - 1) % arcs;
  const int from = run.first / 2;  // the gauge at its beginning, or before it
  const int to = (last + 1) / 2 % gauges.count;
  const double from_deg = gauges.angle_deg(from), to_deg = gauges.angle_deg(to);
  if (run.count == 1 && run.first % 2 == 0) return fmt::format("over gauge {} ({:.0f} deg)", from, from_deg);
  if (run.count == 1)
    return fmt::format("between gauges {} and {} ({:.0f} to {:.0f} deg)", from, to, from_deg, to_deg);
  return fmt::format("from gauge {} to gauge {} ({:.0f} to {:.0f} deg)", from, to, from_deg, to_deg);
}

void count(Coverage& coverage, const config::Gauges& gauges, const calibration::TouchSearch& search,
           const Eigen::VectorXd& strains, const calibration::KnownTouch& known) {
  if (coverage.touches.empty()) coverage.touches.resize(2 * static_cast<std::size_t>(gauges.count));
  if (known.isUntouched()) {
    ++coverage.untouched;
    return;
  }
  const double place_rad =
      known.angle_deg ? *known.angle_deg * kRadPerDeg : search.guess(strains)[calibration::kPlace];
  ++coverage.touches[static_cast<std::size_t>(arcOf(gauges, place_rad))];
  if (known.normal_n_per_m) ++coverage.loads;
  if (known.angle_deg) coverage.directions_deg.push_back(*known.angle_deg);
}

Coverage coverageOf(const config::Gauges& gauges, const calibration::TouchSearch& search, const Rows& rows) {
  Coverage coverage;
  coverage.touches.resize(2 * static_cast<std::size_t>(gauges.count));
  for (std::size_t i = 0; i < rows.size(); ++i)
    count(coverage, gauges, search, rows.strains[i], rows.known[i]);
  return coverage;
}

}  // namespace strainfinger::session
