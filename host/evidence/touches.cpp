#include "host/evidence/touches.hpp"

#include <cmath>

#include "host/base/angles.hpp"
#include "host/evidence/uniform.hpp"

namespace strainfinger::evidence {
namespace {

/// What is drawn of each touch; each draw takes two channels.
enum Drawn : std::uint32_t { kGauge, kSide, kOffset, kLean, kLoad, kWidth };

}  // namespace

simulation::Touch TouchDraws::at(std::uint64_t number) const {
  const auto share = [&](Drawn what) { return uniform(draws_, number, 2 * what) + 0.5; };
  const auto within = [&](const Range& range, Drawn what) {
    return range.least + (range.most - range.least) * share(what);
  };
  const int gauge = static_cast<int>(share(kGauge) * gauges_.count) % gauges_.count;
  const int before = (gauge + gauges_.count - 1) % gauges_.count;
  const bool beyond = share(kSide) < 0.5;
  const double side = beyond ? 1 : -1, gap_deg = gauges_.gap_deg(beyond ? gauge : before);
  const double angle_deg = gauges_.angle_deg(gauge) + side * gap_deg * within(ranges_.offset_pitch, kOffset);
  const double lean_rad = side * within(ranges_.lean_deg, kLean) * kRadPerDeg;
  const double ratio = ranges_.load_n_per_m.most / ranges_.load_n_per_m.least;
  const double load = ranges_.load_n_per_m.least * std::pow(ratio, share(kLoad));
  return {.angle_rad = angle_deg * kRadPerDeg,
          .normal_n_per_m = load * std::cos(lean_rad),
          .tangential_n_per_m = load * std::sin(lean_rad),
          .width_m = within(ranges_.width_m, kWidth),
          .profile = ranges_.profile};
}

}  // namespace strainfinger::evidence
