#include "host/session/session_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "host/base/wrapped.hpp"
#include "host/session/rules.hpp"

namespace strainfinger::session {
namespace {

using live::Canvas, live::Style;

constexpr int kTouchesPerGlyph = 4, kMostGlyphs = 4;
/// Columns of the table, which has room on 80.
constexpr int kOverColumn = 13, kNextColumn = 25, kSigmaColumn = 37;
/// Windows with fewer rows have none to leave empty: the default ring has room on 24.
constexpr int kAiryRows = 28;
constexpr double kSilentAfter_s = 1;

/// Its standard error, if there is a mark.
std::string zeroOfAngleText(const Assessment& known) {
  return std::isfinite(known.zeroOfAngle_deg) ? fmt::format("+-{:.2f} deg", known.zeroOfAngle_deg)
                                              : "not known";
}

class SessionPainter {
 public:
  SessionPainter(const SessionView& view, const config::Gauges& gauges, const live::ScreenForm& form)
      : view_(view), gauges_(gauges), isUnicode_(form.unicode), canvas_(form.rows, form.columns) {}

  Canvas paint() {
    heading();
    paragraph(view_.next, Style::kStrong);
    if (!view_.complaint.empty()) paragraph("No fit yet: " + view_.complaint, Style::kBad);
    say(row_++, 0, nowText(view_), Style::kAccent);
    if (!view_.message.empty()) paragraph(view_.message, Style::kStrong);
    worth();
    row_ += space();
    table();
    foot();
    return canvas_;
  }

 private:
  int space() const { return canvas_.rows() < kAiryRows ? 0 : 1; }
  int lastRow() const { return canvas_.rows() - 1; }

  int say(int row, int column, const std::string& text, Style style = Style::kPlain) {
    if (row < lastRow()) return canvas_.text(row, column, text, style);
    return column;
  }

  void paragraph(const std::string& text, Style style) {
    for (const std::string& line : wrapped(text, canvas_.columns())) say(row_++, 0, line, style);
  }

  void heading() {
    const int column = say(row_, 0, fmt::format("{} node {}", view_.bus, view_.node), Style::kStrong);
    const auto knowns = view_.coverage.directions_deg.size();
    int behind = say(row_, column + 2,
                     fmt::format("{} rows: {} untouched, {} of known load, {} of known angle", view_.rows,
                                 view_.coverage.untouched, view_.coverage.loads, knowns));
    if (view_.lost > 0) behind = say(row_, behind + 2, fmt::format("{} lost", view_.lost), Style::kBad);
    if (view_.isFitting) say(row_, behind + 2, "fitting", Style::kFaint);
    row_ += 1 + space();
  }

  void worth() {
    if (!view_.assessment) return;
    const Assessment& known = *view_.assessment;
    const auto each = [&](Eigen::Index i, double scale, int digits) {
      return fmt::format("{:.{}f} > {:.{}f} > {:.{}f}", scale * known.errors.drawn[i], digits,
                         scale * known.errors.known[i], digits, scale * known.errors.bound[i], digits);
    };
    say(row_++, 0, "Errors to come, as drawn > now > noise alone: place " + each(0, 1e3, 3) + " mm");
    say(row_++, 0, "  normal " + each(1, 1, 2) + ", tangential " + each(2, 1, 2) + " N/m");
    say(row_++, 0,
        fmt::format("Unit of force +-{:.1f} %, zero of the angle {}; {} more touches gain {:.0f} %",
                    100 * known.unitOfForce, zeroOfAngleText(known), kGoals.batch, 100 * known.bestGain()));
  }

  void table() {
    say(row_++, 0, "gauge    deg  over it     to the next  sigma: gain     angle    depth    zero",
        Style::kFaint);
    const int room = std::max(0, lastRow() - row_);
    const int shown = gauges_.count <= room ? gauges_.count : std::max(0, room - 1);
    for (int gauge = 0; gauge < shown; ++gauge) gaugeRow(gauge);
    if (shown < gauges_.count)
      say(row_++, 0, fmt::format("{} more gauges: make the window higher", gauges_.count - shown),
          Style::kFaint);
  }

  void gaugeRow(int gauge) {
    say(row_, 0, fmt::format("{:>5} {:>6.1f}", gauge, gauges_.angle_deg(gauge)));
    touches(kOverColumn, 2 * gauge);
    touches(kNextColumn, 2 * gauge + 1);
    if (view_.assessment) {
      const GaugeSigmas& sigma = view_.assessment->gauges[static_cast<std::size_t>(gauge)];
      say(row_, kSigmaColumn,
          fmt::format("{:>6.2f} % {:>6.3f} deg {:>5.1f} um {:>4.1f}e-6", 100 * sigma.gain, sigma.angle_deg,
                      1e6 * sigma.depth_m, 1e6 * sigma.zero_strain));
    }
    ++row_;
  }

  void touches(int column, int arc) {
    const auto at = static_cast<std::size_t>(arc);
    const int count = at < view_.coverage.touches.size() ? view_.coverage.touches[at] : 0;
    const Style style = count < kTouchesPerGlyph ? Style::kBad : Style::kGood;
    say(row_, column, fmt::format("{:>4}", count), style);
    const int glyphs = std::min(kMostGlyphs, count / kTouchesPerGlyph);
    for (int i = 0; i < kMostGlyphs && row_ < lastRow(); ++i)
      canvas_.put(row_, column + 5 + i, i < glyphs ? (isUnicode_ ? U'█' : U'#') : (isUnicode_ ? U'·' : U'.'),
                  i < glyphs ? style : Style::kFaint);
  }

  void foot() {
    if (view_.prompt.empty())
      canvas_.text(lastRow(), 0, kSessionKeys, Style::kFaint);
    else
      canvas_.text(lastRow(), 0, view_.prompt, Style::kStrong);
  }

  const SessionView& view_;
  const config::Gauges& gauges_;
  bool isUnicode_;
  Canvas canvas_;
  int row_ = 0;
};

const char* textOf(RowsUse use) {
  switch (use) {
    case RowsUse::kOfFaults:
      return ", but are not what the finger reads once it is mended: start again with another -o then";
    case RowsUse::kOfOldZero:
      return ", of the old zero: start again with another -o; --strains and --touches calibrate with these "
             "alone";
    case RowsUse::kToGoOn:
      break;
  }
  return ": the same command goes on with them";
}

}  // namespace

std::string errorsText(const TouchesToCome& errors) {
  const auto each = [&](const char* name, Eigen::Index i, double scale, const char* unit, int digits) {
    return fmt::format("{} {:.{}f} {} (drawn {:.{}f}, noise alone {:.{}f})", name, scale * errors.known[i],
                       digits, unit, scale * errors.drawn[i], digits, scale * errors.bound[i], digits);
  };
  return each("place", 0, 1e3, "mm", 3) + ", " + each("normal", 1, 1, "N/m", 2) + ", " +
         each("tangential", 2, 1, "N/m", 2);
}

std::string keptText(std::size_t rows, std::optional<std::size_t> fittedRows, RowsUse use,
                     const std::string& strainsPath, const std::string& touchesPath) {
  if (rows == 0) return "no rows were collected";
  const std::size_t newer = rows - std::min(rows, fittedRows.value_or(rows));
  const std::string notFitted = newer == 0
                                    ? ""
                                    : fmt::format("the last {} kept, but not in this fit; ",
                                                  newer == 1 ? "row is" : fmt::format("{} rows are", newer));
  return fmt::format("{}{} rows are kept in {} and {}{}", notFitted, rows, strainsPath, touchesPath,
                     textOf(use));
}

std::string nowText(const SessionView& view) {
  if (view.sets == 0) return "waiting for readings";
  if (view.silent_s > kSilentAfter_s) return fmt::format("no readings for {:.0f} s", view.silent_s);
  switch (view.now) {
    case Verdict::kTooSoon:
      return fmt::format("at rest for {:.0f} s", view.atRest_s);
    case Verdict::kKept:
      return "kept";
    case Verdict::kOverRange:
      return fmt::format("gauge {} is beyond its range: press less", view.peakGauge);
    case Verdict::kWeak:
      return view.atRest_s >= 1 ? fmt::format("at rest for {:.0f} s", view.atRest_s)
                                : "nothing touches it, or hardly";
    case Verdict::kUnsteady:
      return "too quick: more slowly";
    case Verdict::kAlike:
      return "as before: go on to another place, load or side";
    case Verdict::kEnough:
      break;
  }
  return "enough of this: press harder or softer, or rub to a side";
}

Canvas drawSession(const SessionView& view, const config::Gauges& gauges, const live::ScreenForm& form) {
  return SessionPainter(view, gauges, form).paint();
}

std::string sessionLine(const SessionView& view) {
  std::string text = fmt::format(
      "{:.1f} s  {} rows: {} untouched, {} of known load, {} of known angle; {} lost", view.time_s, view.rows,
      view.coverage.untouched, view.coverage.loads, view.coverage.directions_deg.size(), view.lost);
  if (view.assessment)
    text += fmt::format(
        "; errors to come: {}; unit of force +-{:.1f} %, zero of the angle {}; {} more touches would gain "
        "{:.0f} %",
        errorsText(view.assessment->errors), 100 * view.assessment->unitOfForce,
        zeroOfAngleText(*view.assessment), kGoals.batch, 100 * view.assessment->bestGain());
  if (!view.complaint.empty()) text += "; no fit yet: " + view.complaint;
  return text + " | " + view.next;
}

}  // namespace strainfinger::session
