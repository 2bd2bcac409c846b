// Figs. 8 and 9: singular values of T C, and how many matter.

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "host/contact/decompositions.hpp"
#include "host/contact/slope_map.hpp"
#include "host/paper/figure_makers.hpp"
#include "host/plot/style.hpp"

namespace strainfinger::paper {
namespace {

constexpr int kShown = 20;
constexpr std::array kLevels{0.1, 0.01};
constexpr std::array kClaimedCounts{8L, 11L};

/// Widths of fig. 9 in 2 mm of the paper's finger: 1, 1.5 .. 6 mm.
constexpr int kWidths = 11;
constexpr double widthOf(int i) { return 0.5 + 0.25 * i; }

constexpr const char* kValuesPanel = R"(
set xlabel 'index'; set ylabel 'singular value / largest'; set logscale y; set format y '10^{%T}'
set xrange [0:21]; set yrange [1e-6:2]
set arrow 1 from 0,0.1 to 21,0.1 nohead linecolor rgb faint dashtype 3
set arrow 2 from 0,0.01 to 21,0.01 nohead linecolor rgb faint dashtype 3
plot data('values') using 1:2 every ::1 with linespoints pointtype 7 linewidth 1.4 linecolor rgb blue title 'pressure and shear', \
     '' using 1:(gap(3)) every ::1 with linespoints pointtype 6 dashtype 2 linewidth 1.4 linecolor rgb vermilion title 'pressure only'
)";

constexpr const char* kCountsPanel = R"(
set xlabel 'width of the contact (mm)'; set ylabel 'singular values'; set yrange [0:*]; set offsets graph 0.03,graph 0.03,0,0
plot data('counts') using ($1*1e3):2 every ::1 with points pointtype 7 linecolor rgb blue title 'above 1/10', \
     tenthAt + tenthPerMm * x with lines linecolor rgb blue notitle, \
     '' using ($1*1e3):3 every ::1 with points pointtype 7 linecolor rgb vermilion title 'above 1/100', \
     hundredthAt + hundredthPerMm * x with lines linecolor rgb vermilion notitle
)";

/// Largest first, over the largest.
std::vector<double> relativeValues(const Subject& subject, double width_m, bool withShear) {
  contact::SlopeMapRequest request;
  request.width_rad = width_m / subject.annulus.outer_radius_m;
  request.withShear = withShear;
  std::vector<double> values;
  for (const auto& pair : contact::singularPairs(contact::SlopeMap(subject.annulus, request)))
    values.push_back(pair.value);
  const double largest = values.front();
  for (double& value : values) value /= largest;
  return values;
}

long countAbove(const std::vector<double>& values, double level) {
  return std::ranges::count_if(values, [level](double value) { return value > level; });
}

/// Columns: width [m], then the count above each level.
std::vector<std::vector<double>> countRows(const Subject& subject) {
  std::vector<std::vector<double>> rows;
  for (int i = 0; i < kWidths; ++i) {
    const double width_m = subject.contactWidth_m() * widthOf(i);
    const std::vector<double> values = relativeValues(subject, width_m, true);
    rows.push_back({width_m});
    for (const double level : kLevels) rows.back().push_back(static_cast<double>(countAbove(values, level)));
  }
  return rows;
}

/// The straight line of least squares through a column of countRows().
struct Line {
  double at0, perMm, worst;

  Line(const std::vector<std::vector<double>>& rows, std::size_t column) {
    Eigen::MatrixX2d widths(rows.size(), 2);
    Eigen::VectorXd counts(rows.size());
    for (Eigen::Index i = 0; i < counts.size(); ++i) {
      const auto& row = rows[static_cast<std::size_t>(i)];
      widths.row(i) << 1, row[0] * 1e3;
      counts[i] = row[column];
    }
    const Eigen::Vector2d line = contact::leastSquares(widths, counts);
    at0 = line[0];
    perMm = line[1];
    worst = (counts - widths * line).cwiseAbs().maxCoeff();
  }
};

}  // namespace

plot::Picture singularValuePicture(const Subject& subject) {
  plot::DataFile data{"values", {"index", "relative", "relative_pressure_only"}, {}};
  const auto both = relativeValues(subject, subject.contactWidth_m(), true);
  const auto pressure = relativeValues(subject, subject.contactWidth_m(), false);
  for (std::size_t i = 0; i < std::min<std::size_t>(kShown, both.size()); ++i)
    data.rows.push_back({static_cast<double>(i + 1), both[i],
                         i < pressure.size() ? pressure[i] : std::numeric_limits<double>::quiet_NaN()});
  return {800, 560, std::string(plot::kStyle) + kValuesPanel, {std::move(data)}};
}

std::vector<Claim> singularValueClaims() {
  const Subject paper = paperSubject();
  const auto both = relativeValues(paper, paper.contactWidth_m(), true);
  const auto pressure = relativeValues(paper, paper.contactWidth_m(), false);
  const long tenth = countAbove(both, kLevels[0]), hundredth = countAbove(both, kLevels[1]);
  const bool isTenth = tenth == kClaimedCounts[0], isHundredth = hundredth == kClaimedCounts[1];
  return {
      {"singular-values",
       "for 2 mm and n_c = 300, 8 singular values of T C are above 1/10 of the largest and 11 above 1/100 "
       "(sec. 5, fig. 8)",
       fmt::format("{} and {} (pressure without shear: {} and {}); the closest to their levels are the {}th, "
                   "{:.4f}, and the {}th, {:.4f}",
                   tenth, hundredth, countAbove(pressure, kLevels[0]), countAbove(pressure, kLevels[1]),
                   tenth, both[static_cast<std::size_t>(tenth - 1)], hundredth,
                   both[static_cast<std::size_t>(hundredth - 1)]),
       isTenth && isHundredth   ? Verdict::kBorneOut
       : isTenth || isHundredth ? Verdict::kInPart
                                : Verdict::kNotBorneOut}};
}

plot::Picture countPicture(const Subject& subject) {
  plot::DataFile data{"counts", {"width_m", "above_tenth", "above_hundredth"}, countRows(subject)};
  const Line tenth(data.rows, 1), hundredth(data.rows, 2);
  const std::string numbers =
      fmt::format("tenthAt = {}; tenthPerMm = {}; hundredthAt = {}; hundredthPerMm = {}\n", tenth.at0,
                  tenth.perMm, hundredth.at0, hundredth.perMm);
  return {800, 560, plot::kStyle + numbers + kCountsPanel, {std::move(data)}};
}

std::vector<Claim> countClaims() {
  const auto rows = countRows(paperSubject());
  const Line tenth(rows, 1), hundredth(rows, 2);
  std::vector<double> tenths, hundredths;
  for (const auto& row : rows) {
    tenths.push_back(row[1]);
    hundredths.push_back(row[2]);
  }
  const double worst = std::max(tenth.worst, hundredth.worst);
  return {{"counts-grow",
           "the number of significant singular values grows linearly with the width of the contact (sec. 5, "
           "fig. 9)",
           fmt::format(
               "1, 1.5 .. 6 mm: {} above 1/10, {} above 1/100: {:.2f} and {:.2f} per mm, within {:.2f} of "
               "straight lines",
               fmt::join(tenths, " "), fmt::join(hundredths, " "), tenth.perMm, hundredth.perMm, worst),
           worst < 1 ? Verdict::kBorneOut : Verdict::kNotBorneOut}};
}

}  // namespace strainfinger::paper
