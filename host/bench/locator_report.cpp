#include "host/bench/locator_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/base/table_writer.hpp"
#include "host/bench/cells.hpp"

namespace strainfinger::bench {
namespace {

/// Three digits of a ratio to the bound; what is far from it says so.
std::string ratio(double value) { return value >= 100 ? "> 100" : number(value, value < 10 ? 2 : 0); }

std::string ratios(const Score& score) {
  return fmt::format("{} / {} / {}", ratio(score.overBound[0]), ratio(score.overBound[1]),
                     ratio(score.overBound[2]));
}

std::string thousands(double value) {
  if (std::isnan(value)) return "-";
  const long long whole = std::llround(value);
  if (whole < 1000) return fmt::format("{}", whole);
  return fmt::format("{},{:03}", thousands(static_cast<double>(whole / 1000)), whole % 1000);
}

std::string countCell(const Count& count) {
  return std::isnan(count.median) ? "-"
                                  : fmt::format("{} ({})", thousands(count.median), thousands(count.most95));
}

std::string markdownRow(const MethodResult& result, const Counts& counts) {
  const auto& [clean, little, much] = result.score;
  std::string row = fmt::format("| {} | {} | {} | {} ({}) | {} | {} | {} |", result.name, ratios(little),
                                share(little.gross, little.readings), number(clean.arc_um, 2),
                                share(clean.gross, clean.readings), ratios(much),
                                share(much.gross, much.readings), thousands(result.time_ns));
  for (std::size_t core = 0; core < kCores.size(); ++core)
    row.append(" ").append(countCell(counts.of(core, result.name, kTimedLevel))).append(" |");
  return row;
}

/// Instructions where they are fewest on a Cortex-M4: with the FPU for those that have a use for it.
double countOnM4(const MethodResult& result, const Counts& counts, std::size_t level) {
  return counts.of(result.usesFloat ? kM4WithFpu : kM4, result.name, level).median;
}

/// Okabe & Ito's colours, told apart by the colour-blind too.
constexpr const char* kStyle = R"(
set encoding utf8
set border 3 linecolor '#555555'
set tics nomirror out scale 0.6 textcolor '#333333'
set grid xtics ytics linecolor '#E6E6E6' linetype 1
set logscale xy; set format x '10^{%L}'; set format y '%g'
set key off
set style line 1 linecolor rgb '#0072B2' pointtype 7 pointsize 1.4
set style line 2 linecolor rgb '#D55E00' pointtype 6 pointsize 1.2 linewidth 1.6
set style line 3 linecolor rgb '#777777' linewidth 1.4 dashtype 2
set multiplot layout 1,2 margins 0.055,0.80,0.12,0.92 spacing 0.065
)";

struct Point {
  std::size_t number;
  bool ours;
  double cost;
  double arc_um;
};

const char* colourOf(bool ours) { return ours ? "#0072B2" : "#D55E00"; }

/// Its number, on three sides in turn: neighbours are often of one family.
std::string label(const Point& point) {
  constexpr std::array<const char*, 3> kAway{"-1.3,0", "0,0.9", "0,-0.9"};
  return fmt::format("set label \"{}\" at first {},first {} center offset {} font ',10' textcolor '{}'\n",
                     point.number, point.cost, point.arc_um, kAway[point.number % kAway.size()],
                     colourOf(point.ours));
}

std::string legend(const std::vector<MethodResult>& results, const std::vector<Point>& points) {
  constexpr double kTop = 0.88, kMostLine = 0.045;
  const double line = std::min(kMostLine, kTop / static_cast<double>(points.size()));
  std::string script;
  double height = kTop;
  for (const Point& point : points) {
    script += fmt::format("set label \"{} {}\" at screen 0.81,screen {:.3f} left font ',10' textcolor '{}'\n",
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

std::string panelScript(std::size_t level, bool counted, const std::vector<Point>& points, double bound_um) {
  std::string script =
      fmt::format("set title 'noise {} of the peak strain'\nset xlabel '{}'\nset yrange [{}:*]\n",
                  kLevelSettings[level].name,
                  counted ? "instructions a fit, median, Cortex-M4 (float methods: with FPU)"
                          : "ns a fit on this machine",
                  bound_um / 2);
  for (const Point& point : points) script += label(point);
  return script +
         fmt::format(
             "set label \"Cramer-Rao bound\" at graph 0.99,first {0} right offset 0,-0.7 font ',10' "
             "textcolor '#777777'\n"
             "plot {0} with lines linestyle 3, data('level{1}') using 2:($4==0 ? $3 : NaN) every ::1 with "
             "points linestyle 2, '' using 2:($4==1 ? $3 : NaN) every ::1 with points linestyle 1\n"
             "unset label\nunset ylabel\n",
             bound_um, level);
}

/// Is `other` at least as good as `ours` at this level? Two percent are the readings' luck.
bool isAsGood(const Score& other, const Score& ours) {
  constexpr double kLuck = 1.02;
  return other.gross <= ours.gross && other.arcOfAll_um <= kLuck * ours.arcOfAll_um &&
         other.overBound[1] <= kLuck * ours.overBound[1] && other.overBound[2] <= kLuck * ours.overBound[2];
}

}  // namespace

std::string locatorVerdict(const std::vector<MethodResult>& results, const Counts& counts) {
  const MethodResult& ours = results.front();
  const MethodResult* best = nullptr;
  const auto cost = [&](const MethodResult& result) { return countOnM4(result, counts, kTimedLevel); };
  for (const MethodResult& other : results) {
    if (!other.usesFloat || std::isnan(cost(other)) ||
        !isAsGood(other.score[kTimedLevel], ours.score[kTimedLevel]))
      continue;
    if (best == nullptr || cost(other) < cost(*best)) best = &other;
  }
  if (best == nullptr) return "";
  return fmt::format(
      "The cheapest other method with no larger error and no more gross errors at 0.1 %, {}, takes {:.1f} "
      "times the instructions of {} on a Cortex-M4 with an FPU, which ours doesn't use.\n",
      best->name, cost(*best) / cost(ours), ours.name);
}

std::string locatorMarkdown(const std::vector<MethodResult>& results, const Counts& counts) {
  std::string text =
      "| method | error / bound at 0.1 % (angle / P / Q) | gross | clean: um of arc (gross) | error / bound "
      "at 1 % | "
      "gross | ns here |";
  for (const char* core : kCores) text.append(" ").append(core).append(" |");
  text += "\n|--|--|--|--|--|--|--|--|--|--|\n";
  for (const MethodResult& result : results) text.append(markdownRow(result, counts)).append("\n");
  return text;
}

void writeLocatorCsv(std::FILE* stream, const std::vector<MethodResult>& results, const Counts& counts) {
  std::vector<std::string> columns{"method",
                                   "noise",
                                   "seed",
                                   "contacts",
                                   "gross",
                                   "angle_over_bound",
                                   "normal_over_bound",
                                   "tangential_over_bound",
                                   "arc_rms_um",
                                   "arc_worst_um",
                                   "arc_rms_of_all_um",
                                   "normal_rms_n_per_m",
                                   "tangential_rms_n_per_m",
                                   "time_ns"};
  for (const char* core : {"m4", "m4_fpu", "m0plus"})
    for (const char* what : {"median", "95", "most"})
      columns.push_back(fmt::format("{}_{}_counted", core, what));
  TableWriter table(stream, TableFormat::kCsv, columns);
  for (const MethodResult& result : results) {
    for (std::size_t level = 0; level < kLevels; ++level) {
      const Score& score = result.score[level];
      const LevelSettings& settings = kLevelSettings[level];
      std::vector<Cell> row{result.name,
                            settings.relativeNoise,
                            static_cast<std::int64_t>(settings.seed),
                            std::int64_t{score.readings},
                            std::int64_t{score.gross},
                            score.overBound[0],
                            score.overBound[1],
                            score.overBound[2],
                            score.arc_um,
                            score.arcWorst_um,
                            score.arcOfAll_um,
                            score.normal_n_per_m,
                            score.tangential_n_per_m,
                            result.time_ns};
      for (std::size_t core = 0; core < kCores.size(); ++core) {
        const Count count = counts.of(core, result.name, level);
        row.insert(row.end(), {count.median, count.most95, count.most});
      }
      table.row(row);
    }
  }
}

plot::Picture locatorPicture(const std::vector<MethodResult>& results, const Counts& counts) {
  plot::Picture picture{1600, 720, kStyle, {}};
  picture.script += "set ylabel 'error of place, RMS of all answers (um of arc)'\n";
  picture.script += legend(results, pointsOf(results, counts, kTimedLevel));
  for (const std::size_t level : {std::size_t{1}, std::size_t{2}}) {
    const auto points = pointsOf(results, counts, level);
    plot::DataFile data{fmt::format("level{}", level), {"number", "cost", "arc_rms_of_all_um", "ours"}, {}};
    for (const Point& point : points)
      data.rows.push_back(
          {static_cast<double>(point.number), point.cost, point.arc_um, point.ours ? 1.0 : 0.0});
    picture.script += panelScript(level, !counts.empty(), points, results.back().score[level].arcBound_um);
    picture.data.push_back(std::move(data));
  }
  picture.script += "unset multiplot\n";
  return picture;
}

}  // namespace strainfinger::bench
