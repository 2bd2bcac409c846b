#pragma once
// Parts of texts.

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace strainfinger {

inline constexpr std::string_view kBlanks = " \t\r\n";

/// Without the blanks around it.
constexpr std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// ASCII letters in lower case.
inline std::string lowerCase(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

/// With `by` at each `place`, which is not empty.
inline std::string replacedAll(std::string text, std::string_view place, std::string_view by) {
  for (auto at = text.find(place); at != text.npos; at = text.find(place, at + by.size()))
    text.replace(at, place.size(), by);
  return text;
}

}  // namespace strainfinger
