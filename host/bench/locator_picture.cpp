#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "host/bench/locator_report.hpp"
#include "host/plot/style.hpp"

namespace strainfinger::bench {
namespace {

constexpr const char* kPanels = R"(
set logscale xy
set key off
set style line 1 linecolor rgb blue pointtype 7 pointsize 1.4
set style line 2 linecolor rgb vermilion pointtype 6 pointsize 1.2 linewidth 1.6
set style line 3 linecolor rgb faint linewidth 1.4 dashtype 2
set multiplot layout 2,3 margins 0.04,0.845,0.06,0.96 spacing 0.045,0.09
)";
constexpr const char* kErrorAxis = "set ylabel 'error of place, RMS of all answers (um of arc)'\n";

struct Point {
  std::size_t number;
  bool ours;
  double cost;
  double arc_um;
};

/// What a close-up shows.
struct Area {
  double leastCost, mostCost;
  double least_um, most_um;

  bool holds(const Point& point) const {
    return point.cost > leastCost && point.cost < mostCost && point.arc_um > least_um &&
           point.arc_um < most_um;
  }
};
Area around(const Point& point) {
  return {point.cost / 1.25, point.cost * 2.6, point.arc_um / 1.4, point.arc_um * 4.6};
}

/// What is drawn of one level.
struct LevelPanel {
  std::size_t number;
  std::vector<Point> points;
  double bound_um;
  Area closeUp;
};

const char* colourOf(bool ours) { return ours ? "blue" : "vermilion"; }

/// Its number, two lines above it, one above and one below in turn: neighbours are often of one family.
std::string label(const Point& point) {
  constexpr std::array<const char*, 3> kAway{"0,1.9", "0,0.9", "0,-0.9"};
  return fmt::format("set label \"{}\" at first {},first {} center offset {} font ',10' textcolor rgb {}\n",
                     point.number, point.cost, point.arc_um, kAway[point.number % kAway.size()],
                     colourOf(point.ours));
}

std::string labels(const LevelPanel& panel, bool ofCloseUp) {
  std::string script;
  for (const Point& point : panel.points)
    if (panel.closeUp.holds(point) == ofCloseUp) script += label(point);
  return script;
}

std::string legend(const std::vector<MethodResult>& results, const std::vector<Point>& points) {
  constexpr double kTop = 0.95, kMostLine = 0.03;
  const double line = std::min(kMostLine, kTop / static_cast<double>(points.size()));
  std::string script;
  double height = kTop;
  for (const Point& point : points) {
    script +=
        fmt::format("set label \"{} {}\" at screen 0.855,screen {:.3f} left font ',10' textcolor rgb {}\n",
                    point.number, results[point.number - 1].name, height, colourOf(point.ours));
    height -= line;
  }
  return script;
}

std::vector<Point> pointsOf(const std::vector<MethodResult>& results, const Counts& counts,
                            std::size_t level) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const double cost = counts.empty() ? results[i].time_ns : countOnM4(results[i], counts, level);
    if (!std::isnan(cost))
      points.push_back({i + 1, !results[i].usesFloat, cost, results[i].score[level].arcOfAll_um});
  }
  return points;
}

/// The first of ours that has the least error; of others where there is none.
const Point& bestOfOurs(const std::vector<Point>& points) {
  return *std::min_element(points.begin(), points.end(), [](const Point& a, const Point& b) {
    if (a.ours != b.ours) return a.ours;
    return a.ours && a.arc_um < b.arc_um;
  });
}

std::string plotOf(const LevelPanel& panel) {
  return fmt::format(
      "plot {0} with lines linestyle 3, data('level{1}') using 2:($4==0 ? $3 : NaN) every ::1 with points "
      "linestyle 2, '' using 2:($4==1 ? $3 : NaN) every ::1 with points linestyle 1\n"
      "unset label\nunset ylabel\n",
      panel.bound_um, panel.number);
}

/// Everything, with a frame around what the close-up shows.
std::string overview(const LevelPanel& panel) {
  const Area& area = panel.closeUp;
  return fmt::format(
             "set title 'noise {}'\nset xrange [*:*]\nset yrange [{}:*]\n"
             "set format x '10^{{%L}}'; set format y '%g'\n"
             "set object 1 rectangle from {},{} to {},{} fillstyle empty border linecolor '#555555'\n"
             "set label \"Cramer-Rao bound\" at graph 0.99,first {} right offset 0,-0.7 font ',10' textcolor "
             "rgb "
             "faint\n",
             kLevelSettings[panel.number].name, panel.bound_um / 2, area.leastCost, area.least_um,
             area.mostCost, area.most_um, panel.bound_um) +
         labels(panel, false) + plotOf(panel) + "unset object 1\n";
}

/// A range, with tics at 1, 1.5, 2, 3, 5 and 7 times powers of ten.
std::string range(const char* axis, double least, double most) {
  std::string tics;
  for (double decade = std::pow(10, std::floor(std::log10(least))); decade < most; decade *= 10)
    for (const double step : {1.0, 1.5, 2.0, 3.0, 5.0, 7.0})
      if (decade * step > least && decade * step < most)
        tics += fmt::format("{}{:g}", tics.empty() ? "" : ",", decade * step);
  return fmt::format("set {0}tics ({1})\nset {0}range [{2}:{3}]\n", axis, tics, least, most);
}

std::string closeUp(const LevelPanel& panel, bool counted) {
  const Area& area = panel.closeUp;
  return fmt::format("set title 'noise {}: the frame above'\nset xlabel '{}'\nset format x '%g'\n",
                     kLevelSettings[panel.number].name,
                     counted ? "instructions a fit, median, Cortex-M4 (float methods: with FPU)"
                             : "ns a fit on this machine") +
         range("x", area.leastCost, area.mostCost) + range("y", area.least_um, area.most_um) +
         labels(panel, true) + plotOf(panel);
}

}  // namespace

plot::Picture locatorPicture(const std::vector<MethodResult>& results, const Counts& counts) {
  plot::Picture picture{2200, 1240, std::string(plot::kStyle) + kPanels, {}};
  std::string closeUps;
  picture.script += kErrorAxis + legend(results, pointsOf(results, counts, kTimedLevel));
  for (const std::size_t number : {kTimedLevel, kNoisyLevel, kWideLevel}) {
    const auto points = pointsOf(results, counts, number);
    if (points.empty()) continue;
    const LevelPanel panel{number, points, results.back().score[number].arcBound_um,
                           around(bestOfOurs(points))};
    plot::DataFile data{fmt::format("level{}", number), {"number", "cost", "arc_rms_of_all_um", "ours"}, {}};
    for (const Point& point : points)
      data.rows.push_back(
          {static_cast<double>(point.number), point.cost, point.arc_um, point.ours ? 1.0 : 0.0});
    picture.script += overview(panel);
    closeUps += closeUp(panel, !counts.empty());
    picture.data.push_back(std::move(data));
  }
  picture.script += kErrorAxis + closeUps + "unset multiplot\n";
  return picture;
}

}  // namespace strainfinger::bench
