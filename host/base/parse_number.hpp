#pragma once
// Numbers in texts, as std::from_chars reads them: no blanks, no +, not more than the type holds; NaN and
// infinities are numbers.

#include <charconv>
#include <optional>
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

}  // namespace strainfinger
