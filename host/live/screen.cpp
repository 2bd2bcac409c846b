#include "host/live/screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/base/angles.hpp"
#include "host/base/round_scale.hpp"
#include "host/base/text_parts.hpp"
#include "host/base/wrapped.hpp"
#include "host/live/value_text.hpp"
#include "host/live/words.hpp"

namespace strainfinger::live {
namespace {

constexpr int kBlockRows = 9;    ///< of a finger with its dial, the empty row behind it included
constexpr int kBriefRows = 3;    ///< of a finger with all its numbers
constexpr int kHeadingRows = 2;  ///< of a bus, the empty row below it included
constexpr int kDialRows = 3, kDialColumns = 6;  ///< its radii: a character is twice as high as wide
constexpr int kTextColumn = 19, kBarColumn = 50;
constexpr int kNarrowestBar = 8;

struct Glyphs {
  char32_t ring, spread, contact, second, centre, full, uncertain, empty, zero, more;
  const char* pick;
};
constexpr Glyphs kUnicode{U'·', U'○', U'●', U'◆', U'+', U'█', U'▒', U'·', U'│', U'…', "▸"};
constexpr Glyphs kAscii{'.', 'o', '@', '%', '+', '#', '~', '.', '|', '>', ">"};

double barEnd_n(double value_n) { return roundScale(std::max(value_n, 0.1)); }

/// Places of the dial, counter-clockwise from the right, as the finger is seen from its tip.
class Dial {
 public:
  Dial(Canvas& canvas, int row, int column) : canvas_(canvas), row_(row), column_(column) {}

  void put(double angle_deg, char32_t glyph, Style style) {
    const double angle_rad = angle_deg * kRadPerDeg;
    canvas_.put(row_ + kDialRows - static_cast<int>(std::lround(kDialRows * std::sin(angle_rad))),
                column_ + kDialColumns + static_cast<int>(std::lround(kDialColumns * std::cos(angle_rad))),
                glyph, style);
  }
  /// An arc; all the ring where it is more than that.
  void arc(double middle_deg, double half_deg, char32_t glyph, Style style) {
    const double most_deg = std::min(half_deg, 180.0);
    for (double off_deg = -most_deg; off_deg <= most_deg; off_deg += 5)
      put(middle_deg + off_deg, glyph, style);
  }
  void centre(char32_t glyph) { canvas_.put(row_ + kDialRows, column_ + kDialColumns, glyph, Style::kFaint); }

 private:
  Canvas& canvas_;
  int row_, column_;
};

/// Numbers from `low` to `high` along a row.
class Bar {
 public:
  Bar(Canvas& canvas, int row, double low, double high)
      : canvas_(canvas), row_(row), low_(low), high_(high), width_(canvas.columns() - kBarColumn - 10) {}

  bool hasRoom() const { return width_ >= kNarrowestBar; }
  void fill(double from, double to, char32_t glyph, Style style) {
    if (std::isnan(from) || std::isnan(to)) return;
    const int last = place(std::max(from, to));
    for (int i = place(std::min(from, to)); i <= last; ++i) canvas_.put(row_, kBarColumn + i, glyph, style);
  }
  void caption(const std::string& text) { canvas_.text(row_, kBarColumn + width_ + 1, text, Style::kFaint); }

 private:
  int place(double value) const {
    const double share = std::clamp((value - low_) / (high_ - low_), 0.0, 1.0);
    return static_cast<int>(std::lround(share * (width_ - 1)));
  }
  Canvas& canvas_;
  int row_;
  double low_, high_;
  int width_;
};

class Painter {
 public:
  Painter(const ScreenContent& content, const ScreenForm& form)
      : content_(content),
        isUnicode_(form.unicode),
        glyphs_(form.unicode ? kUnicode : kAscii),
        canvas_(form.rows, form.columns) {}

  Canvas paint() {
    for (const BusView& bus : content_.buses)
      for (const FingerView& finger : bus.fingers) fingers_.push_back(&finger);
    const int fingerRows = roomForFinger();
    if (fingerRows == kBlockRows) spareRows_ = std::max(canvas_.rows() - rowsWith(kBlockRows), 0);
    const int hidden = fingerRows == 1 ? hiddenAbove() : 0;
    int row = -hidden;
    std::size_t index = 0;
    for (const BusView& bus : content_.buses) {
      heading(row, bus);
      row += kHeadingRows;
      for (std::size_t i = 0; i < bus.fingers.size(); ++i, ++index) {
        const int spareRows = spareRows_;
        if (isOnScreen(row)) finger(row, index, fingerRows);
        row += fingerRows + spareRows - spareRows_;
      }
    }
    foot(hidden + row - (canvas_.rows() - 1));
    return canvas_;
  }

 private:
  /// The most rows of a finger with which all of them are shown.
  int roomForFinger() const {
    if (rowsWith(kBlockRows) <= canvas_.rows() && canvas_.columns() >= kBarColumn) return kBlockRows;
    return rowsWith(kBriefRows) <= canvas_.rows() ? kBriefRows : 1;
  }

  /// Above the foot.
  bool isOnScreen(int row) const { return row >= 0 && row < canvas_.rows() - 1; }

  /// Rows that make room for the finger that is picked, where each has one: keys are for that one.
  int hiddenAbove() const {
    int row = 0;
    std::size_t index = 0;
    for (const BusView& bus : content_.buses) {
      row += kHeadingRows;
      for (std::size_t i = 0; i < bus.fingers.size(); ++i, ++row)
        if (index++ == content_.selected) return std::max(row - (canvas_.rows() - 2), 0);
    }
    return 0;
  }

  void finger(int row, std::size_t index, int rows) {
    if (rows == kBlockRows) return block(row, index);
    if (rows == kBriefRows) return brief(row, index);
    line(row, index);
  }

  /// Rows of everything, where a finger has so many.
  int rowsWith(int fingerRows) const {
    return kHeadingRows * static_cast<int>(content_.buses.size()) +
           fingerRows * static_cast<int>(fingers_.size()) + 1;
  }

  /// Canvas::text(), in ASCII where nothing else is to be had; a mark stands where its end is cut off.
  int say(int row, int column, std::string text, Style style = Style::kPlain) {
    if (!isUnicode_) text = replacedAll(std::move(text), "±", "+-");
    const int end = canvas_.text(row, column, text, style);
    if (!text.empty() && end > canvas_.columns())
      canvas_.put(row, canvas_.columns() - 1, glyphs_.more, style);
    return end;
  }

  void heading(int row, const BusView& bus) {
    if (!isOnScreen(row)) return;
    int column = say(row, 0, bus.name, Style::kStrong);
    column =
        say(row, column + 2, fmt::format("{} frames/s  load {:.1f} %", bus.framesPerSecond, bus.load * 100));
    if (bus.missed > 0)
      say(row, column + 2, fmt::format("{} frames not read in time", bus.missed), Style::kBad);
    if (bus.fingers.empty())
      say(row + 1, 0, "no finger heard yet: each sends a HEARTBEAT ten times a second");
  }

  void foot(int hiddenRows) {
    const std::string more =
        hiddenRows > 0 ? fmt::format("{} more rows: make the window higher  ", hiddenRows) : "";
    int column = 0;
    if (!content_.message.empty()) column = say(canvas_.rows() - 1, 0, content_.message, Style::kStrong) + 2;
    say(canvas_.rows() - 1, column, more + content_.keys, Style::kFaint);
  }

  int name(int row, std::size_t index) {
    const FingerView& finger = *fingers_[index];
    const bool isPicked = index == content_.selected && fingers_.size() > 1;
    say(row, 0, isPicked ? glyphs_.pick : " ", Style::kAccent);
    int column = say(row, 2, fmt::format("node {}", finger.node), Style::kStrong);
    const bool runs =
        finger.heartbeat.state == FingerState::kRun && !finger.isSilent() && !finger.isForeign();
    return say(row, column + 2, stateWord(finger), runs ? Style::kGood : Style::kBad);
  }

  /// Angle and normal force; the column behind them.
  int numbersOf(int row, int column, const can::TouchReport& touch) {
    column = say(row, column, angleText(touch), Style::kAccent) + 2;
    return say(row, column, "normal " + normalText(touch)) + 2;
  }

  /// A finger in one row: what is wrong, whether the numbers are to be trusted, and as many of them as fit.
  void line(int row, std::size_t index) {
    const FingerView& finger = *fingers_[index];
    int column = name(row, index) + 2;
    const std::string warnings = warningsText(finger), flags = flagsText(finger);
    if (!warnings.empty()) column = say(row, column, warnings, Style::kBad) + 2;
    if (!finger.isTouched()) {
      say(row, column, "no touch", Style::kFaint);
      return;
    }
    if (!flags.empty()) column = say(row, column, flags, Style::kFaint) + 2;
    column = numbersOf(row, column, *finger.touch);
    say(row, column, "tangential " + tangentialText(*finger.touch));
  }

  /// A finger with all its numbers.
  void brief(int top, std::size_t index) {
    constexpr int kIndent = 4;
    const FingerView& finger = *fingers_[index];
    const int named = name(top, index) + 2;
    int column = kIndent;
    if (finger.isTouched()) {
      const can::TouchReport& touch = *finger.touch;
      say(top, numbersOf(top, named, touch), flagsText(finger), Style::kFaint);
      int next = say(top + 1, kIndent, "tangential " + tangentialText(touch)) + 2;
      next = say(top + 1, next, "width " + widthText(touch)) + 2;
      say(top + 1, next, qualityText(touch), Style::kFaint);
      if (touch.second) column = say(top + 2, kIndent, "second " + contactText(*touch.second)) + 2;
    } else {
      say(top, named, "no touch", Style::kFaint);
    }
    say(top + 2, column, warningsText(finger), Style::kBad);
  }

  static std::string contactText(const can::ContactReport& contact) {
    return fmt::format("{}  {}  {}", angleText(contact), normalText(contact), tangentialText(contact));
  }

  /// A finger with all that is known of it.
  void block(int top, std::size_t index) {
    const FingerView& finger = *fingers_[index];
    int column = name(top, index);
    column = say(top, column + 2, "up " + durationText(finger.heartbeat.uptime_s), Style::kFaint);
    if (finger.heartbeat.temperature_degC != kNotKnown<std::int8_t>)
      column = say(top, column + 2, fmt::format("{} degC", finger.heartbeat.temperature_degC), Style::kFaint);
    say(top, column + 2, flagsText(finger));
    dial(top + 1, finger);
    if (finger.isTouched())
      numbers(top + 1, finger);
    else
      say(top + 1, kTextColumn, finger.touch ? "nothing touches it" : "no touch known", Style::kFaint);
    say(warnings(top + 6, finger), kTextColumn, statistics(finger), Style::kFaint);
  }

  /// In as many rows as it takes and no other finger needs; the row below them.
  int warnings(int row, const FingerView& finger) {
    const auto parts = wrapped(warningsText(finger), canvas_.columns() - kTextColumn);
    std::vector<std::string> rows(1);
    for (const std::string& part : parts)
      if (rows.back().empty())
        rows.back() = part;
      else if (spareRows_ > 0)
        rows.push_back(part), --spareRows_;
      else
        rows.back().append(" ").append(part);  // cut off, with a mark
    for (const std::string& text : rows) say(row++, kTextColumn, text, Style::kBad);
    return row;
  }

  static std::string statistics(const FingerView& finger) {
    std::string text = fmt::format("{} contacts/s", finger.contactsPerSecond);
    if (!std::isnan(finger.jitter_s)) text += fmt::format("  jitter {:.1f} ms", finger.jitter_s * 1e3);
    text += fmt::format("  {} lost", finger.lost);
    if (finger.restarts > 0) text += fmt::format("  {} restarts", finger.restarts);
    return finger.gauges ? text + "  zero " + durationText(finger.gauges->zero_age_s) + " old" : text;
  }

  void numbers(int top, const FingerView& finger) {
    const can::TouchReport& touch = *finger.touch;
    const double end_n = barEnd_n(finger.strongest_n);
    label(top, "angle", angleText(touch));
    label(top + 1, "normal", normalText(touch));
    label(top + 2, "tangential", tangentialText(touch));
    label(top + 3, "width", widthText(touch));
    bar(top + 1, 0, end_n, touch.normal_n, touch.sigmaNormal_n);
    bar(top + 2, -end_n, end_n, touch.tangential_n, touch.sigmaTangential_n);
    quality(top, touch);
    if (!touch.second) return;
    label(top + 4, "second", contactText(*touch.second));
    canvas_.put(top + 4, kTextColumn + 7, glyphs_.second, Style::kAccent);
  }

  /// Behind the angle, or in a narrow window in the row of a second contact.
  void quality(int top, const can::TouchReport& touch) {
    const std::string text = qualityText(touch);
    const bool fits = kBarColumn + static_cast<int>(text.size()) <= canvas_.columns();
    if (fits || touch.second)
      say(top, kBarColumn, text, Style::kFaint);
    else
      say(top + 4, kTextColumn, text, Style::kFaint);
  }

  void label(int row, const char* name, const std::string& value) {
    say(row, kTextColumn, name, Style::kFaint);
    say(row, kTextColumn + 11, value, Style::kStrong);
  }

  void bar(int row, double low_n, double high_n, double value_n, double sigma_n) {
    Bar bar(canvas_, row, low_n, high_n);
    if (!bar.hasRoom()) return;
    bar.fill(low_n, high_n, glyphs_.empty, Style::kFaint);
    bar.fill(0, value_n, glyphs_.full, Style::kAccent);
    bar.fill(value_n - sigma_n, value_n + sigma_n, glyphs_.uncertain, Style::kAccent);
    bar.fill(0, 0, glyphs_.zero, Style::kPlain);
    bar.caption(fmt::format("{:g} N", high_n));
  }

  void dial(int top, const FingerView& finger) {
    Dial dial(canvas_, top, 3);
    dial.arc(0, 180, glyphs_.ring, Style::kFaint);
    dial.centre(glyphs_.centre);
    if (!finger.isTouched()) return;
    const can::TouchReport& touch = *finger.touch;
    if (touch.second) contact(dial, *touch.second, glyphs_.second);
    contact(dial, touch, glyphs_.contact);
  }

  void contact(Dial& dial, const can::ContactReport& contact, char32_t glyph) {
    if (std::isnan(contact.angle_deg)) return;
    if (!std::isnan(contact.alternative_deg))
      dial.put(contact.angle_deg + contact.alternative_deg, glyphs_.spread, Style::kAccent);
    if (!std::isnan(contact.sigmaAngle_deg))
      dial.arc(contact.angle_deg, contact.sigmaAngle_deg, glyphs_.spread, Style::kAccent);
    dial.put(contact.angle_deg, glyph, Style::kAccent);
  }

  const ScreenContent& content_;
  std::vector<const FingerView*> fingers_{};  ///< of all buses
  int spareRows_ = 0;                         ///< that no finger takes so far
  bool isUnicode_;
  const Glyphs& glyphs_;
  Canvas canvas_;
};

}  // namespace

Canvas drawScreen(const ScreenContent& content, const ScreenForm& form) {
  return Painter(content, form).paint();
}

}  // namespace strainfinger::live
