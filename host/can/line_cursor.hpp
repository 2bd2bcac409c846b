#pragma once
// A place in a line of text, and the small steps that read from it.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace strainfinger::can {

/// hexValue() of each character: most of what is in a log is looked up here.
inline constexpr auto kHexValues = [] {
  std::array<std::int8_t, 256> values{};
  values.fill(-1);
  for (int digit = 0; digit < 16; ++digit) {
    values[static_cast<unsigned char>("0123456789ABCDEF"[digit])] = static_cast<std::int8_t>(digit);
    values[static_cast<unsigned char>("0123456789abcdef"[digit])] = static_cast<std::int8_t>(digit);
  }
  return values;
}();

/// The value of a hexadecimal digit, or -1.
constexpr int hexValue(char c) { return kHexValues[static_cast<unsigned char>(c)]; }

constexpr bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Reads beyond the end see '\0'.
class LineCursor {
 public:
  explicit LineCursor(std::string_view line) : line_(line) {}

  bool atEnd() const { return at_ >= line_.size(); }
  char peek(std::size_t ahead = 0) const { return at_ + ahead < line_.size() ? line_[at_ + ahead] : '\0'; }

  /// Steps over `text` if it stands here.
  bool skip(std::string_view text) {
    const bool there = line_.substr(std::min(at_, line_.size()), text.size()) == text;
    if (there) at_ += text.size();
    return there;
  }

  /// What stands here up to the next blank or colour.
  std::string_view token() const {
    std::size_t end = at_;
    while (end < line_.size() && !isBlank(line_[end]) && line_[end] != '\033') ++end;
    return {line_.data() + std::min(at_, line_.size()), end - at_};
  }

  /// Steps over up to `most` decimal digits (at most 18); returns how many, 0 (and no step) if fewer than
  /// `least`.
  std::size_t digits(std::int64_t& value, std::size_t least, std::size_t most) {
    std::size_t count = 0;
    value = 0;
    for (; count < most && peek(count) >= '0' && peek(count) <= '9'; ++count)
      value = value * 10 + (peek(count) - '0');
    if (count < least) return 0;
    at_ += count;
    return count;
  }

  /// Blanks, and the escape sequences that colour a terminal (candump -c): ESC [ numbers m.
  void skipBlanks() {
    while (!atEnd()) {
      const std::size_t colourEnd = peek() == '\033' && peek(1) == '[' ? line_.find('m', at_) : line_.npos;
      if (colourEnd != line_.npos)
        at_ = colourEnd + 1;
      else if (isBlank(peek()))
        ++at_;
      else
        return;
    }
  }

 protected:
  std::string_view line_;
  std::size_t at_ = 0;
};

}  // namespace strainfinger::can
