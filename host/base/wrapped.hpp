#pragma once
// Text in rows.

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace strainfinger {

/// Words to rows of so many columns; a longer word has a row of its own.
inline std::vector<std::string> wrapped(std::string_view text, int columns) {
  std::vector<std::string> rows;
  std::string row;
  while (!text.empty()) {
    const auto end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!row.empty() && static_cast<int>(row.size() + 1 + word.size()) > columns)
      rows.push_back(std::exchange(row, {}));
    row.append(row.empty() ? "" : " ").append(word);
  }
  if (!row.empty()) rows.push_back(row);
  return rows;
}

}  // namespace strainfinger
