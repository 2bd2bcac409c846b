#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "host/base/no_value.hpp"
#include "host/bench/error_pages.hpp"
#include "host/plot/style.hpp"

namespace strainfinger::bench {
namespace {

constexpr const char* kMaps = R"(
set border 31; unset grid
set palette defined (0 '#FFFFFF', 0.25 '#CFE5F2', 0.5 '#56B4E9', 0.75 '#0072B2', 1 '#00263A')
set xrange [-0.5:0.5]; set yrange [-45:45]; set ytics 15 format '%g°'; set cbrange [0:*]
set xlabel 'contact, pitches from the nearest gauge'
set key off
set multiplot layout 1,3 margins 0.05,0.94,0.12,0.88 spacing 0.105
set title 'error of place at 30 N/m, RMS (mm of arc)'; set ylabel 'load direction from the normal' offset 1
plot data('map') using 1:2:3 every ::1 with image
unset ylabel
set title 'error of normal load, RMS (N/m)'
plot data('map') using 1:2:4 every ::1 with image
set title 'error of tangential load, RMS (N/m)'
plot data('map') using 1:2:5 every ::1 with image
unset multiplot
)";

constexpr const char* kCurves = R"(
set key inside top center horizontal samplen 2 textcolor '#333333' maxrows 2
set style line 1 linecolor rgb blue linewidth 2 pointtype 7 pointsize 0.8
set style line 2 linecolor rgb blue linewidth 1.4 dashtype 3 pointtype 6 pointsize 0.8
set style line 3 linecolor rgb vermilion linewidth 2 pointtype 7 pointsize 0.8
set style line 4 linecolor rgb vermilion linewidth 1.4 dashtype 3 pointtype 6 pointsize 0.8
set logscale y; set format y '%g'; set yrange [0.001:4]
set multiplot layout 2,3 margins 0.06,0.985,0.08,0.96 spacing 0.06,0.11
)";

/// One line of a panel: what distinguishes its cells, and how it is called.
struct Line {
  double load_n_per_m;
  bool told;
  const char* title;
};
struct Panel {
  const char* sweep;
  const char* name;  ///< of its data files
  const char* xLabel;
  bool logarithmic;
  std::vector<Line> lines;
};

constexpr double kAnyLoad = -1;

const std::vector<Panel>& panels() {
  static const std::vector<Line> loads{{30, true, "30 N/m"}, {5, true, "5 N/m"}};
  static const std::vector<Line> told{{30, true, "tables know"}, {30, false, "tables don't"}};
  static const std::vector<Panel> all{
      {kLoadSweep, "load", "load (N/m)", true, {{kAnyLoad, true, "default finger"}}},
      {kNoiseSweep, "noise", "noise of a gauge (microstrain)", true, loads},
      {kBitsSweep, "bits", "bits of the converter", false, loads},
      {kWidthSweep, "width", "width of the contact (mm)", false, told},
      {kLengthSweep, "length", "length of a gauge (mm)", false, told}};
  return all;
}

plot::DataFile lineData(const std::vector<ErrorCell>& cells, const Panel& panel, std::size_t index) {
  const Line& line = panel.lines[index];
  plot::DataFile data{fmt::format("{}{}", panel.name, index), {"setting", "arc_rms_mm", "arc_95_mm"}, {}};
  for (const ErrorCell& cell : cellsOf(cells, panel.sweep)) {
    if (cell.told != line.told || (line.load_n_per_m != kAnyLoad && cell.load_n_per_m != line.load_n_per_m))
      continue;
    const evidence::Errors& arc = cell.statistics.arc_mm;
    const bool tells = isMostlyCertain(cell.statistics);
    data.rows.push_back({cell.setting, tells ? arc.rms() : kNoValue, tells ? arc.quantile(0.95) : kNoValue});
  }
  return data;
}

std::string panelScript(const Panel& panel) {
  std::string script =
      fmt::format("set xlabel '{}'\n{} logscale x\nset ylabel 'error of place (mm of arc)'\nplot ",
                  panel.xLabel, panel.logarithmic ? "set" : "unset");
  for (std::size_t i = 0; i < panel.lines.size(); ++i)
    script += fmt::format(
        "{0}data('{1}{2}') using 1:(gap(2)) every ::1 with linespoints linestyle {3} title \"{4}: RMS\", "
        "'' using 1:(gap(3)) every ::1 with linespoints linestyle {5} title '95 %'",
        i == 0 ? "" : ", ", panel.name, i, 2 * i + 1, panel.lines[i].title, 2 * i + 2);
  return script + "\n";
}

}  // namespace

plot::Picture errorMapPicture(const std::vector<ErrorCell>& cells) {
  plot::DataFile data{
      "map",
      {"offset_pitch", "direction_deg", "arc_rms_mm", "normal_rms_n_per_m", "tangential_rms_n_per_m"},
      {}};
  for (const ErrorCell& cell : cellsOf(cells, kMapSweep)) {
    const ErrorStatistics& s = cell.statistics;
    data.rows.push_back({cell.setting, cell.direction_deg, s.arc_mm.rms(), s.normal_n_per_m.rms(),
                         s.tangential_n_per_m.rms()});
  }
  return {1500, 480, std::string(plot::kStyle) + kMaps, {std::move(data)}};
}

plot::Picture errorCurvesPicture(const std::vector<ErrorCell>& cells) {
  plot::Picture picture{1500, 820, std::string(plot::kStyle) + kCurves, {}};
  for (const Panel& panel : panels()) {
    picture.script += panelScript(panel);
    for (std::size_t i = 0; i < panel.lines.size(); ++i) picture.data.push_back(lineData(cells, panel, i));
  }
  picture.script += "unset multiplot\n";
  return picture;
}

}  // namespace strainfinger::bench
