#include "host/plot/log_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "common/frames.hpp"
#include "host/base/round_scale.hpp"
#include "host/plot/style.hpp"

namespace strainfinger::plot {
namespace {

constexpr double kMmPerM = 1e3;

// A band is drawn below its line. Colours as in the pictures of
// runs: what is estimated is blue, what is tangential orange.
constexpr const char* kPanels = R"(
set multiplot
set lmargin at screen 0.105; set rmargin at screen 0.985
set xrange [first:last]; set xtics format ''
set style fill transparent solid 0.3 noborder
set tmargin at screen 0.93; set bmargin at screen 0.71
set label 1 heading at graph 0,1.07 left noenhanced font ',13'
set ylabel 'angle'; set yrange [0:360]; set ytics 90 format '%g°'
plot data('angle') using 1:(gap(3)):(gap(4)) skip 1 with filledcurves linecolor rgb lightBlue title '±σ', \
     '' using 1:(gap(2)) skip 1 with lines linewidth 1.4 linecolor rgb blue title 'contact', \
     for [i=1:second] data('second') using 1:(gap(2)) skip 1 with linespoints pointtype 7 pointsize 0.15 linewidth 1.4 \
       linecolor rgb green title 'second contact'
unset label 1
set tmargin at screen 0.67; set bmargin at screen 0.45
set ylabel 'force (N)'; set yrange [*:*]; set ytics autofreq format '%g'; set offsets 0,0,graph 0.05,graph 0.05
plot 0 with lines linewidth 1 linecolor rgb faint notitle, \
     data('force') using 1:(gap(3)):(gap(4)) skip 1 with filledcurves linecolor rgb lightBlue notitle, \
     '' using 1:(gap(6)):(gap(7)) skip 1 with filledcurves linecolor rgb orange notitle, \
     '' using 1:(gap(2)) skip 1 with lines linewidth 1.4 linecolor rgb blue title 'normal', \
     '' using 1:(gap(5)) skip 1 with lines linewidth 1.4 linecolor rgb vermilion title 'tangential', \
     for [i=1:second] data('second') using 1:(gap(3)) skip 1 with linespoints pointtype 7 pointsize 0.15 linewidth 1.4 linecolor rgb green \
       title 'second: normal', \
     for [i=1:second] data('second') using 1:(gap(4)) skip 1 with linespoints pointtype 7 pointsize 0.1 linewidth 1.4 dashtype (6,4) \
       linecolor rgb green title 'tangential', \
     for [i=1:orMore] data('or-more') using 1:(gap(2)) skip 1 with points pointtype 7 pointsize 0.2 \
       linecolor rgb faint title 'σ that or more'
set tmargin at screen 0.41; set bmargin at screen 0.27
set ylabel 'width (mm)'; set yrange [0:*]; set ytics widthTics; set offsets 0,0,graph 0.05,0
if (!widths) set yrange [0:1]; set ytics (); set label 1 'no width is told' at graph 0.5,0.5 center textcolor rgb faint
plot data('width') using 1:(gap(3)):(gap(4)) skip 1 with filledcurves linecolor rgb lightBlue notitle, \
     '' using 1:(gap(2)) skip 1 with lines linewidth 1.4 linecolor rgb blue notitle, \
     for [i=1:orMore] data('or-more') using 1:(gap(3)) skip 1 with points pointtype 7 pointsize 0.2 \
       linecolor rgb faint notitle
unset offsets; unset label 1
set tmargin at screen 0.23; set bmargin at screen 0.085
set ylabel 'flags'; set yrange [flags - 0.5:-0.5]; set xtics format '%g'; set xlabel 'time since the first frame (s)'
plot data('flags') using 1:2 skip 1 with points pointtype 5 pointsize 0.3 linecolor rgb faint notitle
unset multiplot
)";

using Row = std::vector<double>;

/// Ends curves and bands; two empty rows would begin another table.
void endCurves(std::vector<Row>& rows) {
  if (!rows.empty() && !rows.back().empty()) rows.emplace_back();
}

/// The rows of `points`, with an empty one where a curve and its band must break: gnuplot fills a band across
/// rows without values. A row's first `bandColumns` numbers are those that a band needs.
template <typename RowOf, typename Breaks>
std::vector<Row> brokenRows(const std::vector<LogPoint>& points, std::ptrdiff_t bandColumns, RowOf rowOf,
                            Breaks breaks) {
  constexpr auto isUnknown = [](double value) { return std::isnan(value); };
  std::vector<Row> rows;
  const LogPoint* before = nullptr;
  for (const LogPoint& point : points) {
    if (before != nullptr && (point.time_s - before->time_s > kGap_s || breaks(*before, point)))
      endCurves(rows);
    const Row row = rowOf(point);
    if (!std::all_of(row.begin() + 1, row.end(), isUnknown)) rows.push_back(row);
    if (std::any_of(row.begin(), row.begin() + bandColumns, isUnknown)) endCurves(rows);
    before = &point;
  }
  return rows;
}

/// `bound` or, beyond it, `most` or `least`; NaN stays NaN, which std::fmin and std::fmax would make a
/// number.
double atMost(double bound, double most) { return bound > most ? most : bound; }
double atLeast(double bound, double least) { return bound < least ? least : bound; }

bool never(const LogPoint&, const LogPoint&) { return false; }

/// Through 0 deg a line would cross the panel.
bool turns(double from_deg, double to_deg) { return std::fabs(to_deg - from_deg) > 180; }

DataFile angleData(const LogRecord& record) {
  const auto rowOf = [](const LogPoint& point) {
    const can::TouchReport& touch = point.touch;
    return Row{point.time_s, touch.angle_deg, atLeast(touch.angle_deg - touch.sigmaAngle_deg, 0),
               atMost(touch.angle_deg + touch.sigmaAngle_deg, 360)};
  };
  return {"angle",
          {"time_s", "angle_deg", "angle_low_deg", "angle_high_deg"},
          brokenRows(record.points, 4, rowOf, [](const LogPoint& before, const LogPoint& point) {
            return turns(before.touch.angle_deg, point.touch.angle_deg);
          })};
}

DataFile secondData(const LogRecord& record) {
  const auto angleOf = [](const LogPoint& point) {
    return point.touch.second ? point.touch.second->angle_deg : kNoValue;
  };
  const auto rowOf = [&](const LogPoint& point) {
    const auto& second = point.touch.second;
    return Row{point.time_s, angleOf(point), second ? second->normal_n : kNoValue,
               second ? second->tangential_n : kNoValue};
  };
  return {"second",
          {"time_s", "angle_deg", "normal_n", "tangential_n"},
          brokenRows(record.points, 4, rowOf, [&](const LogPoint& before, const LogPoint& point) {
            return turns(angleOf(before), angleOf(point));
          })};
}

DataFile forceData(const LogRecord& record) {
  const auto rowOf = [](const LogPoint& point) {
    const can::TouchReport& touch = point.touch;
    return Row{point.time_s,
               touch.normal_n,
               touch.normal_n - touch.sigmaNormal_n,
               touch.normal_n + touch.sigmaNormal_n,
               touch.tangential_n,
               touch.tangential_n - touch.sigmaTangential_n,
               touch.tangential_n + touch.sigmaTangential_n};
  };
  return {"force",
          {"time_s", "normal_n", "normal_low_n", "normal_high_n", "tangential_n", "tangential_low_n",
           "tangential_high_n"},
          brokenRows(record.points, 7, rowOf, never)};
}

DataFile widthData(const LogRecord& record) {
  const auto rowOf = [](const LogPoint& point) {
    const can::TouchReport& touch = point.touch;
    return Row{point.time_s, touch.width_m * kMmPerM,
               atLeast(touch.width_m - touch.sigmaWidth_m, 0) * kMmPerM,
               (touch.width_m + touch.sigmaWidth_m) * kMmPerM};
  };
  return {"width",
          {"time_s", "width_mm", "width_low_mm", "width_high_mm"},
          brokenRows(record.points, 4, rowOf, never)};
}

/// Between labels that don't overlap, as the panel is low: gnuplot's own steps would be half of that [mm].
double widthTicsOf(const DataFile& width, const DataFile& orMore) {
  constexpr double kMostSteps = 4, kLeast_mm = 1e-3;
  double most_mm = kLeast_mm;
  for (const auto& [file, first] : {std::pair{&width, 1U}, std::pair{&orMore, 2U}})
    for (const Row& row : file->rows)
      for (std::size_t i = first; i < row.size(); ++i)
        if (row[i] > most_mm) most_mm = row[i];
  return roundScale(most_mm / kMostSteps);
}

/// The edges of bands that stand for that or more, as the largest sigma that a finger can say does.
DataFile orMoreData(const LogRecord& record) {
  const can::LargestValues& largest = can::largestValues();
  DataFile data{"or-more", {"time_s", "force_n", "width_mm"}, {}};
  const auto add = [&](const LogPoint& point, bool isOrMore, double force_n, double width_m) {
    if (isOrMore) data.rows.push_back({point.time_s, force_n, width_m * kMmPerM});
  };
  for (const LogPoint& point : record.points) {
    const can::TouchReport& touch = point.touch;
    for (const double side : {-1, 1}) {
      add(point, touch.sigmaNormal_n >= largest.sigmaNormal_n, touch.normal_n + side * touch.sigmaNormal_n,
          kNoValue);
      add(point, touch.sigmaTangential_n >= largest.sigmaTangential_n,
          touch.tangential_n + side * touch.sigmaTangential_n, kNoValue);
    }
    add(point, touch.width_m >= largest.width_m || touch.sigmaWidth_m >= largest.sigmaWidth_m, kNoValue,
        touch.width_m + touch.sigmaWidth_m);
  }
  return data;
}

/// A row of the last panel for each flag, in this order.
constexpr std::span kFlags(kFingerFlagNames);

DataFile flagData(const LogRecord& record) {
  DataFile data{"flags", {"time_s", "flag"}, {}};
  for (const LogPoint& point : record.points)
    for (std::size_t i = 0; i < kFlags.size(); ++i)
      if ((point.touch.flags.raw() >> kFlags[i].value & 1) != 0)
        data.rows.push_back({point.time_s, static_cast<double>(i)});
  return data;
}

/// The names beside the rows of the last panel; gnuplot reads '_' as a subscript.
std::string flagTics() {
  std::string tics;
  for (std::size_t i = 0; i < kFlags.size(); ++i)
    tics += fmt::format("{}'{}' {}", i > 0 ? ", " : "", kFlags[i].name, i);
  return tics;
}

std::string withFlagTics(std::string panels) {
  constexpr std::string_view kPlace = "set ylabel 'flags';";
  panels.replace(panels.find(kPlace), kPlace.size(),
                 fmt::format("unset ylabel; set ytics ({}) noenhanced font ',9';", flagTics()));
  return panels;
}

}  // namespace

Picture logPicture(const LogRecord& record) {
  const double first_s = record.points.empty() ? 0 : record.points.front().time_s;
  const double last_s = record.points.empty() ? 1 : record.points.back().time_s;
  std::string script = kStyle;
  const DataFile width = widthData(record);
  DataFile orMore = orMoreData(record);
  const double widthTics_mm = widthTicsOf(width, orMore);
  std::vector<DataFile> data{angleData(record), forceData(record), width, flagData(record)};
  // What most logs don't have is neither a file nor in the key.
  const auto addIfAny = [&](DataFile file) {
    const bool isAny = !file.rows.empty();
    if (isAny) data.push_back(std::move(file));
    return isAny ? 1 : 0;
  };
  const int anyOrMore = addIfAny(std::move(orMore)), second = addIfAny(secondData(record));
  script += fmt::format(
      "first = {}; last = {}; flags = {}; orMore = {}; second = {}; widths = {}; widthTics = {}; heading = "
      "{}\n",
      first_s, last_s > first_s ? last_s : first_s + 1, kFlags.size(), anyOrMore, second,
      width.rows.empty() ? 0 : 1, widthTics_mm, quoted(record.heading));
  script += withFlagTics(kPanels);
  return {1200, 900, std::move(script), std::move(data)};
}

}  // namespace strainfinger::plot
