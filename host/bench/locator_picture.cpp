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
  return {point.cost / 1.25, point.cost * 4, point.arc_um / 1.4, point.arc_um * 4.6};
}

/// What is drawn of one level.
struct LevelPanel {
  std::size_t number;
  std::vector<Point> points;
  double bound_um;
  Area closeUp;
};

const char* colourOf(bool ours) { return ours ? "blue" : "vermilion"; }

/// In the panel: 0 to 1 from the left and from below.
struct Place {
  double x, y;
};

bool areNear(const Place& a, const Place& b) {
  return std::abs(a.x - b.x) < 0.05 && std::abs(a.y - b.y) < 0.04;  // a number of two digits
}

Place placeOf(const Point& point, const Area& shown) {
  return {std::log(point.cost / shown.leastCost) / std::log(shown.mostCost / shown.leastCost),
          std::log(point.arc_um / shown.least_um) / std::log(shown.most_um / shown.least_um)};
}

/// The number of each point that is drawn, beside it where fewest other points and numbers are.
std::string labels(const LevelPanel& panel, const Area& shown, bool ofCloseUp) {
  constexpr std::array<Place, 8> kBeside{{{0, 0.045},
                                          {0, -0.045},
                                          {-0.055, 0},
                                          {0.055, 0},
                                          {0.04, 0.04},
                                          {-0.04, 0.04},
                                          {0.04, -0.04},
                                          {-0.04, -0.04}}};
  std::vector<Place> taken;
  for (const Point& point : panel.points) taken.push_back(placeOf(point, shown));
  std::string script;
  for (const Point& point : panel.points) {
    if (panel.closeUp.holds(point) != ofCloseUp) continue;
    const Place at = placeOf(point, shown);
    const auto inTheWay = [&](const Place& beside) {
      return std::ranges::count_if(taken, [&](const Place& other) {
        return areNear({at.x + beside.x, at.y + beside.y}, other);
      });
    };
    const Place& beside = *std::ranges::min_element(kBeside, {}, inTheWay);
    taken.push_back({at.x + beside.x, at.y + beside.y});
    script += fmt::format(
        "set label \"{}\" at first {},first {} center offset graph {},graph {} font ',10' textcolor rgb {}\n",
        point.number, point.cost, point.arc_um, beside.x, beside.y, colourOf(point.ours));
  }
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

/// Whole decades of cost; of errors from half the bound.
Area everything(const LevelPanel& panel) {
  const auto [cheapest, dearest] = std::ranges::minmax(panel.points, {}, &Point::cost);
  const double worst_um = std::ranges::max(panel.points, {}, &Point::arc_um).arc_um;
  const auto decade = [](double exponent) { return std::pow(10, exponent); };
  return {decade(std::floor(std::log10(cheapest.cost))), decade(std::ceil(std::log10(dearest.cost))),
          panel.bound_um / 2, decade(std::ceil(std::log10(worst_um)))};
}

/// Everything, with a frame around what the close-up shows.
std::string overview(const LevelPanel& panel) {
  const Area& area = panel.closeUp;
  const Area shown = everything(panel);
  return fmt::format(
             "set title 'noise {}'\nset xrange [{}:{}]\nset yrange [{}:{}]\n"
             "set format x '10^{{%L}}'; set format y '%g'\n"
             "set object 1 rectangle from {},{} to {},{} fillstyle empty border linecolor '#555555'\n"
             "set label \"Cramer-Rao bound\" at graph 0.01,first {} left offset 0,-0.7 font ',10' textcolor "
             "rgb faint\n",
             kLevelSettings[panel.number].name, shown.leastCost, shown.mostCost, shown.least_um,
             shown.most_um, area.leastCost, area.least_um, area.mostCost, area.most_um, panel.bound_um) +
         labels(panel, shown, false) + plotOf(panel) + "unset object 1\n";
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
         labels(panel, area, true) + plotOf(panel);
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
