#include "host/plot/touch_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
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
do for [i=1:words(contacts)] {
  set arrow i from real(word(contacts,i)),graph 0 to real(word(contacts,i)),graph 1 nohead linecolor rgb faint dashtype 3
}
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
unset arrow
set arrow 1 from moment,graph 0 to moment,graph 1 nohead linecolor rgb faint dashtype 3
set tmargin at screen 0.92; set bmargin at screen 0.66
set label 2 'The contact over time' at graph 0,1.06 left font ',13'
set ylabel 'angle'; set yrange [0:360]; set ytics 90 format '%g°'
plot for [c=1:touches] data('track') using 1:(gap(of(c,4))) every ::1 with points pointtype 7 pointsize 0.4 \
       linecolor rgb estimate title legend(c,'estimate'), \
     for [c=1:touches*flagged] '' using 1:(gap(of(c,4))*gap(of(c,9))) every ::1 with points pointtype 7 pointsize 0.4 \
       linecolor rgb faint title legend(c,'flagged'), \
     for [c=1:touches] '' using 1:(gap(of(c,1))) every ::1 with lines linewidth 1 linecolor rgb truth title legend(c,'truth')
unset label 2
set tmargin at screen 0.60; set bmargin at screen 0.44
set ylabel 'error (mm)'; set yrange [-errorRange:errorRange]; set ytics errorRange format '%g'
plot for [c=1:touches] data('track') using 1:(gap(of(c,7))) every ::1 with points pointtype 7 pointsize 0.3 \
       linecolor rgb fitted title legend(c,'estimate - truth'), \
     for [c=1:touches] '' using 1:(gap(of(c,8))) every ::1 with lines linewidth 1.4 dashtype c linecolor rgb estimate \
       title legend(c,'±σ as reported'), \
     for [c=1:touches] '' using 1:(-gap(of(c,8))) every ::1 with lines linewidth 1.4 dashtype c linecolor rgb estimate notitle, \
     0 with lines linewidth 1 linecolor rgb truth notitle
set tmargin at screen 0.38; set bmargin at screen 0.115
set xtics format '%g'; set xlabel 'time (s)'
set ylabel 'line load (N/m)'; set yrange [*:*]; set ytics autofreq format '%g'; set offsets 0,0,graph 0.05,graph 0.05
plot 0 with lines linewidth 1 linecolor rgb faint notitle, \
     for [c=1:touches] data('track') using 1:(gap(of(c,5))) every ::1 with points pointtype 7 pointsize 0.4 \
       linecolor rgb estimate title legend(c,'normal'), \
     for [c=1:touches] '' using 1:(gap(of(c,6))) every ::1 with points pointtype 7 pointsize 0.4 \
       linecolor rgb tangential title legend(c,'tangential'), \
     for [c=1:touches*flagged] '' using 1:(gap(of(c,5))*gap(of(c,9))) every ::1 with points pointtype 7 pointsize 0.4 \
       linecolor rgb faint notitle, \
     for [c=1:touches*flagged] '' using 1:(gap(of(c,6))*gap(of(c,9))) every ::1 with points pointtype 7 pointsize 0.4 \
       linecolor rgb faint notitle, \
     for [c=1:touches] '' using 1:(gap(of(c,2))) every ::1 with lines linewidth 1 linecolor rgb truth title legend(c,'truth'), \
     for [c=1:touches] '' using 1:(gap(of(c,3))) every ::1 with lines linewidth 1 linecolor rgb truth notitle
unset multiplot
)";

/// Error of the estimate as an arc of the surface, the short way around.
double arcError_m(const TrackedContact& contact, double radius_m) {
  return std::remainder(contact.estimate.angle_deg - contact.truth.angle_deg, 360.0) * kRadPerDeg * radius_m;
}

double arcSigma_m(const TrackedContact& contact, double radius_m) {
  return contact.sigmaAngle_deg * kRadPerDeg * radius_m;
}

/// The most at a time, and one at least.
std::size_t mostContacts(const TouchRecord& record) {
  std::size_t most = 1;
  for (const TrackPoint& point : record.track) most = std::max(most, point.contacts.size());
  return most;
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

/// Of each contact in `track`.
constexpr std::array kContactColumns{"true_angle_deg", "true_normal_n_per_m", "true_tangential_n_per_m",
                                     "angle_deg",      "normal_n_per_m",      "tangential_n_per_m",
                                     "arc_error_mm",   "arc_sigma_mm",        "flagged"};

/// "angle_deg", that of a second contact "angle_deg_2".
std::vector<std::string> trackColumns(std::size_t contacts) {
  std::vector<std::string> columns{"time_s"};
  for (std::size_t contact = 1; contact <= contacts; ++contact)
    for (const char* column : kContactColumns)
      columns.push_back(contact == 1 ? column : fmt::format("{}_{}", column, contact));
  return columns;
}

std::array<double, kContactColumns.size()> contactCells(const TrackedContact& contact, double radius_m) {
  const ContactPoint &truth = contact.truth, &estimate = contact.estimate;
  return {withinATurn_deg(truth.angle_deg),
          truth.normal_n_per_m,
          truth.tangential_n_per_m,
          withinATurn_deg(estimate.angle_deg),
          estimate.normal_n_per_m,
          estimate.tangential_n_per_m,
          arcError_m(contact, radius_m) * kMilli,
          arcSigma_m(contact, radius_m) * kMilli,
          contact.isFlagged ? 1 : kNoValue};
}

/// No values in the columns that are left.
void fillUp(std::vector<double>& row, std::size_t contacts) {
  row.resize(1 + contacts * kContactColumns.size(), kNoValue);
}

std::vector<double> trackRow(const TrackPoint& point, std::size_t contacts, double radius_m) {
  std::vector<double> row{point.time_s};
  for (const TrackedContact& contact : point.contacts) {
    const auto cells = contactCells(contact, radius_m);
    row.insert(row.end(), cells.begin(), cells.end());
  }
  fillUp(row, contacts);
  return row;
}

/// A line of the truth would cross the panel: it runs through 0 deg, or another touch takes the column.
bool isBroken(const TrackPoint& before, const TrackPoint& after) {
  const auto touches = [](const TrackPoint& point) {
    return std::ranges::count_if(
        point.contacts, [](const TrackedContact& contact) { return !std::isnan(contact.truth.angle_deg); });
  };
  if (touches(before) != touches(after)) return true;
  for (std::size_t i = 0; i < std::min(before.contacts.size(), after.contacts.size()); ++i)
    if (std::fabs(withinATurn_deg(before.contacts[i].truth.angle_deg) -
                  withinATurn_deg(after.contacts[i].truth.angle_deg)) > 180)
      return true;
  return false;
}

DataFile trackData(const TouchRecord& record) {
  const std::size_t contacts = mostContacts(record);
  DataFile data{"track", trackColumns(contacts), {}};
  for (std::size_t i = 0; i < record.track.size(); ++i) {
    const TrackPoint& point = record.track[i];
    if (i > 0 && isBroken(record.track[i - 1], point)) {
      data.rows.push_back({point.time_s});
      fillUp(data.rows.back(), contacts);
    }
    data.rows.push_back(trackRow(point, contacts, record.outerRadius_m));
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
  for (const TrackPoint& point : record.track)
    for (const TrackedContact& contact : point.contacts) {
      errors.push_back(std::fabs(arcError_m(contact, record.outerRadius_m)) * kMilli);
      sigmas.push_back(arcSigma_m(contact, record.outerRadius_m) * kMilli);
    }
  const double needed = std::max(quantile(std::move(errors), 0.9), quantile(std::move(sigmas), 0.5));
  return needed == 0 ? 1 : roundScale(needed);
}

std::string contactText(const ContactPoint& contact) {
  if (std::isnan(contact.angle_deg)) return "no contact";
  return fmt::format("{:.2f}°, {:.1f} N/m normal, {:+.1f} N/m tangential", withinATurn_deg(contact.angle_deg),
                     contact.normal_n_per_m, contact.tangential_n_per_m);
}

/// Of several contacts a line each.
std::string shortText(const TrackedContact& contact) {
  const auto text = [](const ContactPoint& point) {
    return std::isnan(point.angle_deg)
               ? "nothing"
               : fmt::format("{:.2f}°, {:.1f} N/m, {:+.1f} along", withinATurn_deg(point.angle_deg),
                             point.normal_n_per_m, point.tangential_n_per_m);
  };
  return fmt::format("{}: told {}", text(contact.truth), text(contact.estimate));
}

std::vector<std::string> contactLines(const std::vector<TrackedContact>& contacts) {
  const TrackedContact only = contacts.empty() ? TrackedContact{} : contacts.front();
  if (contacts.size() < 2)
    return {"truth: " + contactText(only.truth), "estimate: " + contactText(only.estimate)};
  std::vector<std::string> lines;
  for (const TrackedContact& contact : contacts) lines.push_back(shortText(contact));
  return lines;
}

/// The words at the bottom, on the side of the panel that the first contact leaves free.
std::string profileText(const TouchRecord& record) {
  std::string places;
  for (const TrackedContact& contact : record.contacts)
    if (!std::isnan(contact.truth.angle_deg))
      places += fmt::format("{} ", withinATurn_deg(contact.truth.angle_deg));
  const auto lines = contactLines(record.contacts);
  const bool isRight =
      record.contacts.empty() || !(withinATurn_deg(record.contacts.front().truth.angle_deg) >= 180);
  return fmt::format(
      "heading = {}\ncontacts = {}\n"
      "set style textbox opaque noborder margins 0.5,0.5\nset label 1 \"{}\" at graph {},{} {} front boxed "
      "textcolor '#333333' font ',10'\n",
      quoted(fmt::format("What {} gauges see at {:.2f} s", record.readings.size(), record.moment_s)),
      plot::quoted(places), fmt::join(lines, "\\n"), isRight ? 0.99 : 0.02,
      0.01 + 0.04 * static_cast<double>(lines.size()), isRight ? "right" : "left");
}

/// of(c,k): column k of contact c's in `track`; legend(c,name): what all contacts have in common is named
/// once.
std::string trackText(const TouchRecord& record) {
  const bool any = record.track.size() > 1;
  const bool anyFlagged = std::ranges::any_of(record.track, [](const TrackPoint& point) {
    return std::ranges::any_of(point.contacts, &TrackedContact::isFlagged);
  });
  return fmt::format(
      "first = {}; last = {}; moment = {}; touches = {}; flagged = {}; errorRange = {}\n"
      "of(c,k) = {} * (c - 1) + k + 1\nlegend(c,name) = c == 1 ? name : ''\n",
      any ? record.track.front().time_s : 0, any ? record.track.back().time_s : 1, record.moment_s,
      mostContacts(record), anyFlagged ? 1 : 0, errorRange_mm(record), kContactColumns.size());
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
