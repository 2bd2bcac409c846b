#include "host/live/canvas.hpp"

#include <algorithm>

namespace strainfinger::live {
namespace {

/// ECMA-48's Select Graphic Rendition, from the plain style.
const char* escapeFor(Style style) {
  switch (style) {
    case Style::kFaint:
      return "\033[0;2m";
    case Style::kStrong:
      return "\033[0;1m";
    case Style::kAccent:
      return "\033[0;36m";
    case Style::kGood:
      return "\033[0;32m";
    case Style::kBad:
      return "\033[0;1;31m";
    case Style::kPlain:
      break;
  }
  return "\033[0m";
}

void appendUtf8(std::string& text, char32_t glyph) {
  const auto append = [&text](char32_t byte) { text.push_back(static_cast<char>(byte)); };
  if (glyph < 0x80) return append(glyph);
  if (glyph < 0x800) {
    append(0xC0 | glyph >> 6);
  } else {
    append(0xE0 | glyph >> 12);
    append(0x80 | (glyph >> 6 & 0x3F));
  }
  append(0x80 | (glyph & 0x3F));
}

/// The code point that begins at text[at] (well-formed, of at most three bytes); `at` goes behind it.
char32_t nextGlyph(std::string_view text, std::size_t& at) {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(at);
  const std::size_t length = first < 0x80 ? 1 : first < 0xE0 ? 2 : 3;
  char32_t glyph = length == 1 ? first : length == 2 ? first & 0x1FU : first & 0x0FU;
  for (std::size_t i = 1; i < length && at + i < text.size(); ++i)
    glyph = glyph << 6 | (byte(at + i) & 0x3FU);
  at += length;
  return glyph;
}

}  // namespace

void Canvas::put(int row, int column, char32_t glyph, Style style) {
  if (row < 0 || row >= rows_ || column < 0 || column >= columns_) return;
  cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
         static_cast<std::size_t>(column)] = {glyph, style};
}

int Canvas::text(int row, int column, std::string_view utf8, Style style) {
  for (std::size_t at = 0; at < utf8.size(); ++column) put(row, column, nextGlyph(utf8, at), style);
  return column;
}

std::vector<std::string> Canvas::lines(bool styled) const {
  std::vector<std::string> result;
  for (int row = 0; row < rows_; ++row)
    result.push_back(line(cells_.data() + static_cast<std::ptrdiff_t>(row) * columns_, styled));
  return result;
}

std::string Canvas::line(const Cell* row, bool styled) const {
  const auto isBlank = [](const Cell& cell) { return cell.glyph == U' '; };
  const Cell* end = row + columns_;
  while (end > row && isBlank(end[-1])) --end;
  std::string text;
  Style style = Style::kPlain;
  const auto turnTo = [&](Style next) {
    if (styled && next != style) text += escapeFor(next);
    style = next;
  };
  for (const Cell* cell = row; cell != end; ++cell) {
    turnTo(cell->style);
    appendUtf8(text, cell->glyph);
  }
  turnTo(Style::kPlain);
  return text;
}

}  // namespace strainfinger::live
