#include "host/design/bounds_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "host/base/no_value.hpp"
#include "host/plot/style.hpp"

namespace strainfinger::design {
namespace {

constexpr double kMilli = 1e3, kMicro = 1e6;

constexpr const char* kBounds = R"(
set multiplot
set tmargin at screen 0.9; set bmargin at screen 0.14
set logscale y; set format y '%g'
marks(low, high) = high > 1000 * low ? '1' : high > 20 * low ? '1 2 5' : '1 1.5 2 3 5 7'
set xlabel 'gauges'; set xtics 2; set offsets 0.6,0.6,0,0
set palette defined (0 '#440154', 1 '#31688E', 2 '#35B779', 3 '#D9C52A'); set cblabel 'radius of the ring (mm)'; set cbtics scale 0.6
unset colorbox
set lmargin at screen 0.1; set rmargin at screen 0.44
set ylabel 'worst sigma of the place (um)'; set yrange [arcLow:arcHigh]
set ytics (); set for [k=-4:9] for [m in marks(arcLow, arcHigh)] ytics add (m * 10.0**k)
good(bound) = column(5) == 0 ? gap(bound) : NaN
bad(bound) = column(5) == 0 ? NaN : gap(bound)
plot data('fingers') using 1:(gap(3)):2 skip 1 with lines linewidth 1.6 palette notitle, \
     '' using 1:(good(3)):2 skip 1 with points pointtype 7 pointsize 0.8 palette notitle, \
     '' using 1:(bad(3)):2 skip 1 with points pointtype 6 pointsize 0.8 palette notitle, \
     NaN with points pointtype 7 pointsize 0.8 linecolor rgb faint title 'no problem', \
     NaN with points pointtype 6 pointsize 0.8 linecolor rgb faint title 'a problem'
if (least < most) set colorbox user origin 0.89,0.14 size 0.015,0.76
set lmargin at screen 0.53; set rmargin at screen 0.87
set ylabel 'worst sigma of the normal load (N/m)'; set yrange [normalLow:normalHigh]
set ytics (); set for [k=-4:9] for [m in marks(normalLow, normalHigh)] ytics add (m * 10.0**k)
set label 1 heading at graph 0,1.06 left
plot data('fingers') using 1:(gap(4)):2 skip 1 with lines linewidth 1.6 palette notitle, \
     '' using 1:(good(4)):2 skip 1 with points pointtype 7 pointsize 0.8 palette notitle, \
     '' using 1:(bad(4)):2 skip 1 with points pointtype 6 pointsize 0.8 palette notitle
unset multiplot
)";

struct Range {
  double low = 1, high = 10;
};

/// Around a column's values, with room for two of the ticks at least: one and the next but one are 2.5 times
/// apart at most.
Range rangeOf(const plot::DataFile& fingers, std::size_t column) {
  constexpr double kLeastRatio = 2.6;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const auto& row : fingers.rows)
    if (!row.empty() && row[column] > 0) {
      least = std::min(least, row[column]);
      most = std::max(most, row[column]);
    }
  if (most == 0) return {};
  const double margin = std::max(std::pow(most / least, 0.05), std::sqrt(kLeastRatio * least / most));
  return {least / margin, most * margin};
}

double shown(double bound) { return std::isfinite(bound) ? bound : kNoValue; }

}  // namespace

plot::Picture boundsPicture(const std::vector<Candidate>& candidates) {
  plot::DataFile fingers{"fingers", {"gauges", "radius_mm", "arc_um", "normal_n_per_m", "problem"}, {}};
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& finger = candidates[i];
    if (i > 0 && finger.radius_m != candidates[i - 1].radius_m) fingers.rows.push_back({});
    const std::optional<Bounds>& bounds = finger.found.bounds;
    fingers.rows.push_back({static_cast<double>(finger.gauges), kMilli * finger.radius_m,
                            shown(bounds ? kMicro * bounds->arc_m.worst : kNoValue),
                            shown(bounds ? bounds->normal_n_per_m.worst : kNoValue),
                            finger.found.problem.empty() ? 0.0 : 1.0});
  }
  const auto [least, most] = std::ranges::minmax_element(candidates, {}, &Candidate::radius_m);
  const double least_mm = kMilli * least->radius_m, most_mm = kMilli * most->radius_m;
  const Range arc = rangeOf(fingers, 2), normal = rangeOf(fingers, 3);
  const std::string range = fmt::format(
      "arcLow = {}; arcHigh = {}; normalLow = {}; normalHigh = {}\n"
      "least = {}; most = {}; heading = {}\nset cbrange [{}:{}]\n",
      arc.low, arc.high, normal.low, normal.high, least_mm, most_mm,
      plot::quoted(most_mm > least_mm ? "" : fmt::format("ring of {:.3g} mm", least_mm)), least_mm,
      most_mm > least_mm ? most_mm : least_mm + 1);
  return {960, 420, plot::kStyle + range + kBounds, {fingers}};
}

}  // namespace strainfinger::design
