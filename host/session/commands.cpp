#include "host/session/commands.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/base/excerpt.hpp"
#include "host/base/parse_number.hpp"
#include "host/base/text_parts.hpp"

namespace strainfinger::session {
namespace {

constexpr double kGravity_m_per_s2 = 9.80665;  // standard gravity (CGPM 1901)

/// A number and what stands behind it.
struct Quantity {
  double value;
  std::string unit;  ///< in lower case
};

/// Complains of a decimal comma, behind which the rest would be taken for the unit.
std::optional<Unclear> decimalCommaIn(std::string_view text) {
  const auto point = withPoint(text.substr(0, text.find_first_not_of("+-0123456789.,")));
  if (!point) return std::nullopt;
  return Unclear{fmt::format("\"{}\": write {} with a point", excerpt(text), *point)};
}

std::optional<Quantity> quantityIn(std::string_view text) {
  const auto value = takeNumber<double>(text);
  if (!value || !std::isfinite(*value)) return std::nullopt;
  return Quantity{*value, lowerCase(trimmed(text))};
}

Command loadOf(std::string_view text, double length_m) {
  if (const auto unclear = decimalCommaIn(text)) return *unclear;
  const auto said = quantityIn(text);
  if (!said)
    return Unclear{fmt::format("\"{}\" is no load: say it as in 200 g, 2 N or 24.5 N/m", excerpt(text))};
  double perUnit = 0;
  if (said->unit == "g") perUnit = 1e-3 * kGravity_m_per_s2 / length_m;
  if (said->unit == "kg") perUnit = kGravity_m_per_s2 / length_m;
  if (said->unit == "n") perUnit = 1 / length_m;
  if (said->unit == "n/m") perUnit = 1;
  if (perUnit == 0)
    return Unclear{fmt::format("\"{}\": say the unit of the load: g, kg, N or N/m", excerpt(text))};
  if (said->value <= 0)
    return Unclear{fmt::format("\"{}\": the load must press: more than 0", excerpt(text))};
  return LoadIs{said->value * perUnit};
}

Command angleOf(std::string_view text) {
  if (const auto unclear = decimalCommaIn(text)) return *unclear;
  const auto said = quantityIn(text);
  if (!said || (said->unit != "" && said->unit != "deg"))
    return Unclear{fmt::format("\"{}\" is no angle: say it in degrees, as in 40", excerpt(text))};
  if (std::abs(said->value) > 360)
    return Unclear{fmt::format(
        "\"{}\": an angle is from -360 to 360 degrees, counter-clockwise seen from the tip", excerpt(text))};
  return AngleIs{said->value < 0 ? said->value + 360 : said->value};
}

}  // namespace

Command parseCommand(std::string_view line, double length_m) {
  const std::string_view text = trimmed(line);
  const auto blank = text.find_first_of(" \t");
  const std::string_view word = text.substr(0, blank);
  const std::string_view rest = blank == text.npos ? "" : trimmed(text.substr(blank));
  if (word == "load") return loadOf(rest, length_m);
  if (word == "angle") return angleOf(rest);
  if (rest.empty() && word == "hold") return Hold{};
  if (rest.empty() && word == "tare") return Tare{};
  if (rest.empty() && word == "skip") return Skip{};
  if (rest.empty() && word == "undo") return Undo{};
  if (rest.empty() && word == "quit") return Quit{};
  return Unclear{fmt::format("\"{}\": say load, angle, hold, skip, undo, tare or quit", excerpt(text))};
}

std::optional<Command> KeyReader::press(unsigned char key) {
  constexpr unsigned char kEscape = 0x1B, kDelete = 0x7F, kBackspace = 0x08;
  if (mode_ == Mode::kKeys) {
    typed_.clear();
    if (key == 'l') mode_ = Mode::kLoad;
    if (key == 'a') mode_ = Mode::kAngle;
    if (key == 't') mode_ = Mode::kTare;
    if (mode_ == Mode::kTare) return MayTare{};
    if (mode_ != Mode::kKeys) return Hold{};
    if (key == 's') return Skip{};
    if (key == 'u') return Undo{};
    if (key == 'q') return Quit{};
    return std::nullopt;
  }
  if (mode_ == Mode::kTare) {
    mode_ = Mode::kKeys;
    return key == 'y' ? std::optional<Command>(Tare{}) : std::nullopt;
  }
  if (key == '\r' || key == '\n') {
    isEntered_ = true;
    return parseCommand((mode_ == Mode::kLoad ? "load " : "angle ") + typed_, length_m_);
  }
  if (key == kEscape) mode_ = Mode::kKeys;
  if ((key == kDelete || key == kBackspace) && !typed_.empty()) typed_.pop_back();
  if (key >= ' ' && key < kDelete && typed_.size() < 40) typed_ += static_cast<char>(key);
  return std::nullopt;
}

void KeyReader::answer(bool isObeyed) {
  const bool isOver =
      isEntered_ ? isObeyed : !isObeyed;  // what was entered is taken; a key's question is moot
  if (isOver) mode_ = Mode::kKeys;
  isEntered_ = false;
}

std::string KeyReader::prompt() const {
  switch (mode_) {
    case Mode::kLoad:
      return "load, with its unit (200 g, 2 N, 24.5 N/m), Return or Esc: " + typed_ + "_";
    case Mode::kAngle:
      return "angle in degrees, Return or Esc: " + typed_ + "_";
    case Mode::kTare:
      return "the finger takes a new zero: does nothing touch it? y: yes, any other key: no";
    case Mode::kKeys:
      break;
  }
  return "";
}

}  // namespace strainfinger::session
