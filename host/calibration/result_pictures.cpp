#include "host/calibration/result_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "host/base/angles.hpp"
#include "host/base/no_value.hpp"
#include "host/plot/style.hpp"

namespace strainfinger::calibration {
namespace {

constexpr double kMicro = 1e6, kPercent = 100;
constexpr int kWide_px = 960;

constexpr const char* kRing = R"(
set multiplot
set lmargin at screen 0.11; set rmargin at screen 0.985
set xrange [-0.6:gauges-0.4]; set xtics 1 format ''
set style fill solid 0.35 noborder
set offsets 0,0,graph 0.05,graph 0.05
panel(top, bottom) = sprintf('set tmargin at screen %g; set bmargin at screen %g', top, bottom)
eval panel(0.93, 0.665)
set ylabel 'gain off (%)'
plot [-0.6:gauges-0.4] '+' using 1:(-tolGain):(tolGain) with filledcurves linecolor rgb '#E6E6E6' title 'as drawn, ±σ allowed', \
     0 with lines linecolor rgb faint notitle, \
     data('ring') using 1:2:(2*column(3)) every ::1 with yerrorbars pointtype 7 pointsize 0.7 linewidth 1.6 linecolor rgb blue title 'as found, ±2σ'
unset key
eval panel(0.635, 0.39)
set ylabel 'angle off (deg)'
plot [-0.6:gauges-0.4] '+' using 1:(-tolAngle):(tolAngle) with filledcurves linecolor rgb '#E6E6E6', 0 with lines linecolor rgb faint, \
     data('ring') using 1:4:(2*column(5)) every ::1 with yerrorbars pointtype 7 pointsize 0.7 linewidth 1.6 linecolor rgb blue
eval panel(0.355, 0.12)
set ylabel 'too deep (um)'; set xtics format '%g'; set xlabel 'gauge'
plot [-0.6:gauges-0.4] '+' using 1:(-tolDepth):(tolDepth) with filledcurves linecolor rgb '#E6E6E6', 0 with lines linecolor rgb faint, \
     data('ring') using 1:6:(2*column(7)) every ::1 with yerrorbars pointtype 7 pointsize 0.7 linewidth 1.6 linecolor rgb blue
unset multiplot
)";

constexpr const char* kCoverage = R"(
set lmargin at screen 0.08; set rmargin at screen 0.97; set tmargin at screen 0.9; set bmargin at screen 0.22
set xrange [0:360]; set xtics 45 format '%g°'; set xlabel 'angle around the ring; grey lines: gauges'
set ylabel 'normal load (N/m)'; set logscale y; set offsets 0,0,0,0
set ytics (1,2,5,10,20,50,100,200,500,1000,2000,5000)
plot data('gauges') using 1:2:(0):3 every ::1 with vectors nohead linecolor rgb '#CCCCCC' notitle, \
     data('touches') using 1:(gap(2)) every ::1 with points pointtype 7 pointsize 0.45 linecolor rgb blue title 'used', \
     '' using 1:(gap(3)) every ::1 with points pointtype 7 pointsize 0.45 linecolor rgb vermilion title 'left out'
)";

constexpr const char* kResiduals = R"(
set multiplot
set logscale y; set format y '%g'; set yrange [low:high]
set ytics (); set for [k=-3:6] for [m in '1 2 5'] ytics add (m * 10.0**k)
set tmargin at screen 0.9; set bmargin at screen 0.22
set lmargin at screen 0.08; set rmargin at screen 0.40
set ylabel 'left over (microstrain, RMS)'
set xlabel 'gauge'; set xrange [-0.6:gauges-0.4]
plot data('gauges') using 1:2 every ::1 with linespoints pointtype 6 linecolor rgb vermilion notitle, \
     '' using 1:3 every ::1 with linespoints pointtype 7 linecolor rgb blue notitle, \
     noise with lines dashtype 2 linecolor rgb black notitle
set lmargin at screen 0.47; set rmargin at screen 0.985
unset ylabel; set xlabel 'row'; set xrange [0:rows+1]
plot data('rows') using 1:(gap(2)) every ::1 with points pointtype 7 pointsize 0.35 linecolor rgb vermilion title 'as drawn', \
     '' using 1:(gap(3)) every ::1 with points pointtype 7 pointsize 0.35 linecolor rgb blue title 'as found', \
     noise with lines dashtype 2 linecolor rgb black title 'noise'
unset multiplot
)";

}  // namespace

plot::Picture ringPicture(const CalibrationResult& result) {
  const Drawing& drawing = result.drawing();
  const config::Tolerance& tolerance = drawing.config().tolerance;
  plot::DataFile ring{"ring",
                      {"gauge", "gain_percent", "sigma_gain_percent", "angle_deg", "sigma_angle_deg",
                       "depth_um", "sigma_depth_um"},
                      {}};
  for (int i = 0; i < drawing.gauges(); ++i) {
    const Estimate gain = result.gain(i), angle = result.angleOffset_deg(i), depth = result.depthOffset_m(i);
    ring.rows.push_back({static_cast<double>(i), kPercent * (gain.value - 1), kPercent * gain.sigma,
                         angle.value, angle.sigma, kMicro * depth.value, kMicro * depth.sigma});
  }
  const std::string values =
      fmt::format("gauges = {}; tolGain = {}; tolAngle = {}; tolDepth = {}\n", drawing.gauges(),
                  kPercent * tolerance.gain, tolerance.angle_deg, kMicro * tolerance.depth_m);
  return {kWide_px, 620, plot::kStyle + values + kRing, {ring}};
}

plot::Picture coveragePicture(const CalibrationResult& result) {
  const config::FingerConfig& config = result.drawing().config();
  plot::DataFile touches{"touches", {"angle_deg", "used_n_per_m", "left_out_n_per_m"}, {}};
  double least = 1e9, most = 1e-9;
  for (const RowResult& row : result.rows()) {
    const double load_n_per_m = row.touch[kNormalLoad];
    if (load_n_per_m <= 0 || row.use == RowUse::kUntouched) continue;
    least = std::min(least, load_n_per_m);
    most = std::max(most, load_n_per_m);
    const bool isUsed = row.use == RowUse::kFitted;
    touches.rows.push_back(
        {degreesOf(row.touch[kPlace]), isUsed ? load_n_per_m : kNoValue, isUsed ? kNoValue : load_n_per_m});
  }
  plot::DataFile gauges{"gauges", {"angle_deg", "from_n_per_m", "length_n_per_m"}, {}};
  for (int i = 0; i < config.gauges.count; ++i)
    gauges.rows.push_back({config.gauges.angle_deg(i), least / 2, 2 * most - least / 2});
  const std::string range = fmt::format("set yrange [{}:{}]\n", least / 1.5, 1.5 * most);
  return {kWide_px, 320, plot::kStyle + range + kCoverage, {gauges, touches}};
}

plot::Picture residualPicture(const CalibrationResult& result, const Residuals& residuals) {
  const auto rowsOf = [](const std::vector<Residuals::Of>& all, double first) {
    std::vector<std::vector<double>> rows;
    for (const Residuals::Of& each : all)
      rows.push_back({first + static_cast<double>(rows.size()), kMicro * each.before_strain,
                      kMicro * each.after_strain});
    return rows;
  };
  const std::vector<std::string> columns{"number", "before_microstrain", "after_microstrain"};
  const double noise = kMicro * result.drawing().config().gauges.noise_strain;
  double low = noise, high = noise;  // of both panels
  for (const auto* all : {&residuals.gauges, &residuals.rows})
    for (const Residuals::Of& each : *all)
      for (const double left : {kMicro * each.before_strain, kMicro * each.after_strain}) {
        if (left > 0) low = std::min(low, left);
        high = std::max(high, left);
      }
  const std::string values =
      fmt::format("gauges = {}; rows = {}; noise = {}; low = {}; high = {}\n", residuals.gauges.size(),
                  residuals.rows.size(), noise, low / 1.3, 1.3 * high);
  return {kWide_px,
          340,
          plot::kStyle + values + kResiduals,
          {{"gauges", columns, rowsOf(residuals.gauges, 0)}, {"rows", columns, rowsOf(residuals.rows, 1)}}};
}

}  // namespace strainfinger::calibration
