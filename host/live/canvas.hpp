#pragma once
// A rectangle of characters to draw a screen on.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace strainfinger::live {

enum class Style : std::uint8_t { kPlain, kFaint, kStrong, kAccent, kGood, kBad };

/// What is put beyond its edges is cut off.
class Canvas {
 public:
  Canvas(int rows, int columns)
      : rows_(rows),
        columns_(columns),
        cells_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns)) {}

  int rows() const { return rows_; }
  int columns() const { return columns_; }

  void put(int row, int column, char32_t glyph, Style style = Style::kPlain);
  /// UTF-8, a column a code point: no wide or combining characters. Returns the column behind it.
  int text(int row, int column, std::string_view utf8, Style style = Style::kPlain);

  /// UTF-8, without blanks at the end of a row. With `styled`, ANSI escape sequences say the styles and a
  /// row that has any ends in the plain one.
  std::vector<std::string> lines(bool styled) const;

 private:
  struct Cell {
    char32_t glyph = U' ';
    Style style = Style::kPlain;
  };
  std::string line(const Cell* row, bool styled) const;

  int rows_, columns_;
  std::vector<Cell> cells_;
};

}  // namespace strainfinger::live
