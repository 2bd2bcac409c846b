#include "host/plot/touch_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "host/base/angles.hpp"
#include "host/base/quantile.hpp"
#include "host/base/round_scale.hpp"
#include "host/plot/style.hpp"

namespace strainfinger::plot {
namespace {

constexpr double kMicro = 1e6;
constexpr double kMilli = 1e3;

// One meaning a colour, the same in all panels; `fitted` is a light `estimate`.
constexpr const char* kColours = R"(
truth = black; estimate = blue; reading = vermilion; tangential = orange; fitted = lightBlue
set multiplot
)";

constexpr const char* kProfilePanels = R"(
set lmargin at screen 0.072; set rmargin at screen 0.475
set xrange [0:360]; set xtics 45 format ''
set arrow 1 from contact,graph 0 to contact,graph 1 nohead linecolor rgb faint dashtype 3
set tmargin at screen 0.92; set bmargin at screen 0.37
set label 2 heading at graph 0,1.025 left font ',13'
set ylabel 'strain (10^{-3})'; set offsets 0,0,graph 0.05,graph 0.05
plot 0 with lines linewidth 1 linecolor rgb faint notitle, \
     data('profile') using 1:3 every ::1 with lines linewidth 5 linecolor rgb fitted title 'fit', \
     data('profile') using 1:2 every ::1 with lines linewidth 1.4 linecolor rgb truth title 'truth', \
     data('readings') using 1:2 every ::1 with points pointtype 7 pointsize 1 linecolor rgb reading title 'gauges'
unset label
set tmargin at screen 0.325; set bmargin at screen 0.115
set xtics format '%g°'; set xlabel 'angle around the ring'
set ylabel 'gauge - fit (10^{-6})'; set offsets 0,0,graph 0.1,graph 0.1
plot 0 with lines linewidth 1 linecolor rgb truth notitle, \
     data('readings') using 1:3:4 every ::1 with yerrorbars pointtype 7 pointsize 1 linewidth 1.4 \
       linecolor rgb reading title 'with the noise of a reading, ±σ'
unset offsets
)";

constexpr const char* kTrackPanels = R"(
set lmargin at screen 0.565; set rmargin at screen 0.985
set xrange [first:last]; set xtics autofreq format ''; unset xlabel
set arrow 1 from moment,graph 0 to moment,graph 1 nohead linecolor rgb faint dashtype 3
set tmargin at screen 0.92; set bmargin at screen 0.66
set label 2 'The contact over time' at graph 0,1.06 left font ',13'
set ylabel 'angle'; set yrange [-20 * several:360]; set ytics 0,90 format '%g°'
plot data('track') using 1:(gap(5)) every ::1 with points pointtype 7 pointsize 0.4 linecolor rgb estimate title 'estimate', \
     '' using 1:(gap(2)) every ::1 with lines linewidth 1 linecolor rgb truth title 'truth', \
     for [i=1:several] '' using 1:(-11 * gap(10)) every ::1 with points pointtype 5 pointsize 0.4 \
       linecolor rgb faint title 'several touches: not compared'
unset label 2
set tmargin at screen 0.60; set bmargin at screen 0.44
set ylabel 'error (mm)'; set yrange [-errorRange:errorRange]; set ytics errorRange format '%g'
plot data('track') using 1:(gap(8)) every ::1 with points pointtype 7 pointsize 0.3 linecolor rgb fitted \
       title 'estimate - truth', \
     '' using 1:(gap(9)) every ::1 with lines linewidth 1.4 linecolor rgb estimate title '±σ as reported', \
     '' using 1:(-gap(9)) every ::1 with lines linewidth 1.4 linecolor rgb estimate notitle, \
     0 with lines linewidth 1 linecolor rgb truth notitle
set tmargin at screen 0.38; set bmargin at screen 0.115
set xtics format '%g'; set xlabel 'time (s)'
set ylabel 'line load (N/m)'; set yrange [*:*]; set ytics autofreq format '%g'; set offsets 0,0,graph 0.05,graph 0.05
plot 0 with lines linewidth 1 linecolor rgb faint notitle, \
     data('track') using 1:(gap(6)) every ::1 with points pointtype 7 pointsize 0.4 linecolor rgb estimate title 'normal', \
     '' using 1:(gap(7)) every ::1 with points pointtype 7 pointsize 0.4 linecolor rgb tangential title 'tangential', \
     '' using 1:(gap(3)) every ::1 with lines linewidth 1 linecolor rgb truth title 'truth', \
     '' using 1:(gap(4)) every ::1 with lines linewidth 1 linecolor rgb truth notitle
unset multiplot
)";

/// Error of the estimate as an arc of the surface, the short way around.
double arcError_m(const TrackPoint& point, double radius_m) {
  return std::remainder(point.estimate.angle_deg - point.truth.angle_deg, 360.0) * kRadPerDeg * radius_m;
}

double arcSigma_m(const TrackPoint& point, double radius_m) {
  return point.sigmaAngle_deg * kRadPerDeg * radius_m;
}

DataFile profileData(const TouchRecord& record) {
  DataFile data{"profile", {"angle_deg", "true_millistrain", "fitted_millistrain"}, {}};
  for (const ProfilePoint& point : record.profile)
    data.rows.push_back({point.angle_deg, point.true_strain * kMilli, point.fitted_strain * kMilli});
  return data;
}

DataFile readingData(const TouchRecord& record) {
  DataFile data{"readings", {"angle_deg", "millistrain", "residual_microstrain", "sigma_microstrain"}, {}};
  for (const GaugeReading& reading : record.readings)
    data.rows.push_back({withinATurn_deg(reading.angle_deg), reading.strain * kMilli,
                         (reading.strain - reading.fitted_strain) * kMicro, reading.sigma_strain * kMicro});
  return data;
}

std::vector<double> trackRow(const TrackPoint& point, double radius_m) {
  const ContactPoint &truth = point.truth, &estimate = point.estimate;
  return {point.time_s,
          withinATurn_deg(truth.angle_deg),
          truth.normal_n_per_m,
          truth.tangential_n_per_m,
          withinATurn_deg(estimate.angle_deg),
          estimate.normal_n_per_m,
          estimate.tangential_n_per_m,
          arcError_m(point, radius_m) * kMilli,
          arcSigma_m(point, radius_m) * kMilli,
          point.areSeveral ? 1 : kNoValue};
}

std::vector<double> gapAt(double time_s) {
  std::vector<double> row(10, kNoValue);
  row[0] = time_s;
  return row;
}

DataFile trackData(const TouchRecord& record) {
  DataFile data{"track",
                {"time_s", "true_angle_deg", "true_normal_n_per_m", "true_tangential_n_per_m", "angle_deg",
                 "normal_n_per_m", "tangential_n_per_m", "arc_error_mm", "arc_sigma_mm", "several_touches"},
                {}};
  for (const TrackPoint& point : record.track) {
    // A gap where the truth runs through 0 deg, or the line would cross the panel.
    if (!data.rows.empty() && std::fabs(data.rows.back()[1] - withinATurn_deg(point.truth.angle_deg)) > 180)
      data.rows.push_back(gapAt(point.time_s));
    data.rows.push_back(trackRow(point, record.outerRadius_m));
  }
  return data;
}

/// As quantileOf() those that are finite; 0 of none.
double quantile(std::vector<double> values, double share) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  return values.empty() ? 0 : quantileOf(std::move(values), share);
}

/// What the error panel must show: 9 of 10 errors and every other sigma, as sigmas rise tenfold between
/// gauges [mm].
double errorRange_mm(const TouchRecord& record) {
  std::vector<double> errors, sigmas;
  for (const TrackPoint& point : record.track) {
    errors.push_back(std::fabs(arcError_m(point, record.outerRadius_m)) * kMilli);
    sigmas.push_back(arcSigma_m(point, record.outerRadius_m) * kMilli);
  }
  const double needed = std::max(quantile(std::move(errors), 0.9), quantile(std::move(sigmas), 0.5));
  return needed == 0 ? 1 : roundScale(needed);
}

std::string contactText(const ContactPoint& contact) {
  if (std::isnan(contact.angle_deg)) return "no contact";
  return fmt::format("{:.2f}°, {:.1f} N/m normal, {:+.1f} N/m tangential", withinATurn_deg(contact.angle_deg),
                     contact.normal_n_per_m, contact.tangential_n_per_m);
}

/// The words at the bottom, on the side of the panel that the contact leaves free.
std::string profileText(const TouchRecord& record) {
  const double contact_deg =
      std::isnan(record.truthThen.angle_deg) ? -1 : withinATurn_deg(record.truthThen.angle_deg);
  return fmt::format(
      "heading = {}\ncontact = {}\n"
      "set label 1 \"truth: {}\\nestimate: {}\" at graph {},0.09 {} textcolor '#333333' font ',10'\n",
      quoted(fmt::format("What {} gauges see at {:.2f} s", record.readings.size(), record.moment_s)),
      contact_deg, contactText(record.truthThen), contactText(record.estimateThen),
      contact_deg < 180 ? 0.99 : 0.02, contact_deg < 180 ? "right" : "left");
}

std::string trackText(const TouchRecord& record) {
  const bool any = record.track.size() > 1;
  const bool anySeveral = std::any_of(record.track.begin(), record.track.end(),
                                      [](const TrackPoint& point) { return point.areSeveral; });
  return fmt::format("first = {}; last = {}; moment = {}; several = {}; errorRange = {}\n",
                     any ? record.track.front().time_s : 0, any ? record.track.back().time_s : 1,
                     record.moment_s, anySeveral ? 1 : 0, errorRange_mm(record));
}

}  // namespace

Picture touchPicture(const TouchRecord& record) {
  std::string script = kStyle;
  script += kColours;
  script.append(profileText(record)).append(kProfilePanels);
  script.append(trackText(record)).append(kTrackPanels);
  return {1500, 720, std::move(script), {profileData(record), readingData(record), trackData(record)}};
}

}  // namespace strainfinger::plot
