#pragma once
// Numbers in texts, as std::from_chars reads them: no blanks, no +, not more than the type holds; NaN and
// infinities are numbers.

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace strainfinger {

/// The number that a text begins with, which is taken off it; nothing where it begins with none.
template <typename Number>
std::optional<Number> takeNumber(std::string_view& text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

/// All of a text as a number; nothing where it is none.
template <typename Number>
std::optional<Number> parseNumber(std::string_view text) {
  const auto number = takeNumber<Number>(text);
  return text.empty() ? number : std::nullopt;
}

/// "0.5" of "0,5": of a text that is a number but for a comma in place of its point; nothing of others.
inline std::optional<std::string> withPoint(std::string_view text) {
  const auto comma = text.find(',');
  const auto isDigit = [&](std::size_t at) { return at < text.size() && text[at] >= '0' && text[at] <= '9'; };
  if (comma == text.npos || comma == 0 || !isDigit(comma - 1) || !isDigit(comma + 1)) return std::nullopt;
  std::string point(text);
  point[comma] = '.';
  return parseNumber<double>(point) ? std::optional(point) : std::nullopt;
}

}  // namespace strainfinger
