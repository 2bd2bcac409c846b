// Fig. 10: the first pairs of slope and pressure, and what of them gauges see.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "host/contact/slope_map.hpp"
#include "host/model/series.hpp"
#include "host/paper/figure_makers.hpp"
#include "host/plot/style.hpp"

namespace strainfinger::paper {
namespace {

constexpr int kPairs = 4, kPoints = 201, kShownHarmonics = 150, kLowHarmonic = 20;

constexpr const char* kBasisPanels = R"(
set multiplot layout 4,3 margins 0.05,0.985,0.07,0.94 spacing 0.05,0.06
set yrange [-1.15:1.15]
do for [k = 1:4] {
  set xrange [-half:half]; set xlabel k == 4 ? 'θ (rad)' : ''
  set label 1 sprintf('%d: slope (full) and shape (dashed)', k) at graph 0,1.09 left
  plot 0 with lines linecolor rgb faint notitle, \
       data('functions') using 1:(column(4*k - 1)/slopes[k]) every ::1 with lines linewidth 1.6 linecolor rgb blue notitle, \
       '' using 1:(column(4*k - 2)/shapes[k]) every ::1 with lines dashtype 2 linewidth 1.2 linecolor rgb lightBlue notitle
  set label 1 'pressure' at graph 0,1.09 left
  plot 0 with lines linecolor rgb faint notitle, \
       data('functions') using 1:(column(4*k)/pressures[k]) every ::1 with lines linewidth 1.6 linecolor rgb vermilion notitle
  set xrange [0:150]; set xlabel k == 4 ? 'harmonic n' : ''
  set label 1 'its coefficients; grey: n up to 20' at graph 0,1.09 left
  set object 1 rectangle from 0,graph 0 to 20,graph 1 behind fillcolor rgb '#F3F3F3' fillstyle solid noborder
  plot 0 with lines linecolor rgb faint notitle, \
       data('coefficients') using 1:(column(k + 1)/coefficients[k]) every ::1 with lines linewidth 1.6 linecolor rgb vermilion notitle
  unset object 1
}
unset multiplot
)";

/// One of the first pairs, as functions.
struct Pair {
  bool isEvenSlope;
  double shearOfUnknowns;  ///< share of the squares of V's column, before the window acts
  contact::FourierTractions tractions;

  /// Of the pressure: its part that is not 0.
  auto coefficients() const { return tractions.col(isEvenSlope ? 1 : 0); }

  /// Squares of some columns' coefficients up to a harmonic.
  double squares(Eigen::Index firstColumn, Eigen::Index columns, Eigen::Index last) const {
    return tractions.block(0, firstColumn, last + 1, columns).squaredNorm();
  }
  double lowShare() const { return squares(0, 2, kLowHarmonic) / squares(0, 2, tractions.rows() - 1); }
  double shearShare() const {
    return squares(2, 2, tractions.rows() - 1) / squares(0, 4, tractions.rows() - 1);
  }
};

std::vector<Pair> firstPairs(const Subject& subject) {
  contact::SlopeMapRequest request;
  request.width_rad = subject.contactWidth_m() / subject.annulus.outer_radius_m;
  const contact::SlopeMap map(subject.annulus, request);
  std::vector<Pair> pairs;
  for (const auto& pair : contact::singularPairs(map)) {
    const double shear = pair.unknowns.tail(pair.unknowns.size() / 2).squaredNorm();  // of 1
    pairs.push_back({pair.isEvenSlope, shear, map.tractions(pair.isEvenSlope, pair.unknowns)});
    if (pairs.size() == kPairs) break;
  }
  return pairs;
}

std::vector<double> anglesOf(const Subject& subject) {
  const double half_rad = subject.contactWidth_m() / 2 / subject.annulus.outer_radius_m;
  std::vector<double> angles_rad;
  for (int i = 0; i < kPoints; ++i) angles_rad.push_back(half_rad * (2.0 * i / (kPoints - 1) - 1));
  return angles_rad;
}

double largestOf(const plot::DataFile& data, std::size_t column) {
  double largest = 0;
  for (const auto& row : data.rows) largest = std::max(largest, std::abs(row[column]));
  return largest;
}

plot::DataFile functionsOf(const Subject& subject, const std::vector<Pair>& pairs) {
  plot::DataFile data{"functions", {"angle_rad"}, {}};
  for (int k = 1; k <= kPairs; ++k)
    for (const char* name : {"shape_m", "slope_m_per_rad", "pressure_pa", "shear_pa"})
      data.columns.push_back(fmt::format("{}_{}", name, k));
  for (const double angle_rad : anglesOf(subject)) {
    data.rows.push_back({angle_rad});
    for (const Pair& pair : pairs) {
      const auto point = contact::surfaceAt(subject.annulus, pair.tractions, angle_rad);
      const auto traction = contact::tractionAt(pair.tractions, angle_rad);
      for (const double value : {point.ur_m, point.urSlope_m, traction.pressure_pa, traction.shear_pa})
        data.rows.back().push_back(value);
    }
  }
  return data;
}

plot::DataFile coefficientsOf(const std::vector<Pair>& pairs) {
  plot::DataFile data{"coefficients", {"n"}, {}};
  for (int k = 1; k <= kPairs; ++k) data.columns.push_back(fmt::format("pressure_pa_{}", k));
  for (Eigen::Index n = 0; n <= kShownHarmonics; ++n) {
    data.rows.push_back({static_cast<double>(n)});
    for (const Pair& pair : pairs) data.rows.back().push_back(pair.coefficients()[n]);
  }
  return data;
}

/// Every `step`-th column's largest value, as gnuplot's array.
std::string scales(const char* name, const plot::DataFile& data, std::size_t first, std::size_t step) {
  std::vector<double> values;
  for (std::size_t i = first; i < data.columns.size(); i += step) values.push_back(largestOf(data, i));
  return fmt::format("array {}[{}] = [{}]\n", name, values.size(), fmt::join(values, ", "));
}

/// Largest departure of a column of functionsOf() from a parity, per its largest value; angles are symmetric.
double oddness(const plot::DataFile& data, std::size_t column, bool isEven) {
  double worst = 0;
  for (std::size_t i = 0; i < data.rows.size(); ++i) {
    const double here = data.rows[i][column], there = data.rows[data.rows.size() - 1 - i][column];
    worst = std::max(worst, std::abs(here - (isEven ? there : -there)));
  }
  return worst / largestOf(data, column);
}

/// 2 mu times the largest e_rr that the pressure makes at the gauges, over the largest pressure.
double visibility(const Subject& subject, const Pair& pair) {
  constexpr std::array kRows{model::kErr};
  constexpr double kSpan_rad = 1, kRelativeError = 1e-9;
  constexpr int kAngles = 501;
  Eigen::MatrixXd table =
      model::truncatedSeries(subject.annulus, subject.gaugeRadius_m, kRows, {}, kRelativeError);
  const auto last = std::min(table.rows(), pair.tractions.rows()) - 1;
  double strain = 0, pressure = 0;
  for (int i = 0; i < kAngles; ++i) {
    double sum = 0;
    model::visitMultiples(
        kSpan_rad * i / (kAngles - 1.0), static_cast<int>(last), [&](int n, double c, double s) {
          sum += table(n, model::kNormal) * pair.coefficients()[n] * (pair.isEvenSlope ? s : c);
        });
    strain = std::max(strain, std::abs(sum));
  }
  for (const double angle_rad : anglesOf(subject))
    pressure = std::max(pressure, std::abs(contact::tractionAt(pair.tractions, angle_rad).pressure_pa));
  return 2 * subject.annulus.shear_modulus_pa * strain / pressure;
}

/// visibility() of each of the first pairs in the paper's finger with another core.
std::vector<double> visibilities(double alpha) {
  Subject subject = paperSubject();
  const double rise_m = subject.gaugeRadius_m - subject.annulus.core_radius_m;
  subject.annulus.core_radius_m = alpha * subject.annulus.outer_radius_m;
  subject.gaugeRadius_m = subject.annulus.core_radius_m + rise_m;
  std::vector<double> found;
  for (const Pair& pair : firstPairs(subject)) found.push_back(visibility(subject, pair));
  return found;
}

Claim parities(const Subject& paper, const std::vector<Pair>& pairs) {
  const plot::DataFile data = functionsOf(paper, pairs);
  double worst = 0, shear = 0, ofUnknowns = 0;
  std::vector<const char*> slopes;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const bool isEven = pairs[k].isEvenSlope;
    worst = std::max({worst, oddness(data, 4 * k + 1, !isEven), oddness(data, 4 * k + 2, isEven),
                      oddness(data, 4 * k + 3, !isEven)});
    shear = std::max(shear, pairs[k].shearShare());
    ofUnknowns = std::max(ofUnknowns, pairs[k].shearOfUnknowns);
    slopes.push_back(isEven ? "even" : "odd");
  }
  return {"parities",
          "odd shape <-> even slope <-> odd pressure, and the reverse; the first four basis functions (sec. "
          "5, fig. 10)",
          fmt::format(
              "slopes of the first four: {}; shapes and pressures are of the other parity to {:.0e}; at most "
              "{:.2f} % of the squares of V's columns is shear, {:.2f} % of those of the windowed tractions' "
              "coefficients",
              fmt::join(slopes, ", "), worst, 100 * ofUnknowns, 100 * shear),
          worst < 1e-9 ? Verdict::kBorneOut : Verdict::kNotBorneOut};
}

Claim oddShapes(const std::vector<Pair>& pairs) {
  std::vector<std::string> shares;
  for (const Pair& pair : pairs)
    shares.push_back(fmt::format("{} {:.3f}", pair.isEvenSlope ? "odd" : "even", pair.lowShare()));
  const auto thick = visibilities(0.7), middle = visibilities(0.85), thin = visibilities(0.93);
  const auto evenOverOdd = [](const std::vector<double>& seen) {
    return (seen[0] + seen[2]) / (seen[1] + seen[3]);
  };
  const bool isDark = pairs[1].lowShare() < 0.05 && pairs[3].lowShare() < 0.05;
  const bool isFiltered = evenOverOdd(thick) > 3 && evenOverOdd(middle) < evenOverOdd(thick);
  return {
      "odd-shapes",
      "the spectrum of odd shapes is near zero at the low frequencies: their low part can't be sensed unless "
      "alpha > 0.85 (sec. 5, fig. 10)",
      fmt::format("share of the pressure's squared coefficients up to the 20th harmonic, by shape: {}. "
                  "Gauges see even shapes {:.1f} times as strongly as odd ones at alpha = 0.7, {:.1f} times "
                  "at 0.85, {:.1f} times at 0.93",
                  fmt::join(shares, ", "), evenOverOdd(thick), evenOverOdd(middle), evenOverOdd(thin)),
      isDark && isFiltered   ? Verdict::kBorneOut
      : isDark || isFiltered ? Verdict::kInPart
                             : Verdict::kNotBorneOut};
}

}  // namespace

plot::Picture basisPicture(const Subject& subject) {
  const std::vector<Pair> pairs = firstPairs(subject);
  plot::DataFile functions = functionsOf(subject, pairs), coefficients = coefficientsOf(pairs);
  const std::string numbers = fmt::format("half = {}\n", functions.rows.back()[0]) +
                              scales("shapes", functions, 1, 4) + scales("slopes", functions, 2, 4) +
                              scales("pressures", functions, 3, 4) +
                              scales("coefficients", coefficients, 1, 1);
  return {1300, 1200, plot::kStyle + numbers + kBasisPanels, {std::move(functions), std::move(coefficients)}};
}

std::vector<Claim> basisClaims() {
  const Subject paper = paperSubject();
  const std::vector<Pair> pairs = firstPairs(paper);
  std::vector<Claim> claims = discriminationClaims();
  claims.insert(claims.begin(), {parities(paper, pairs), oddShapes(pairs)});
  return claims;
}

}  // namespace strainfinger::paper
