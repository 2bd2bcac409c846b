#include "host/base/notice.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>

namespace strainfinger {
namespace {

unsigned char byteOf(char c) { return static_cast<unsigned char>(c); }

/// How many bytes a character of UTF-8 has that begins so; 0: none does.
std::size_t sizeOfCharacter(unsigned char first) {
  if (first < 0x80) return 1;
  if (first < 0xC2 || first > 0xF4) return 0;
  return first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
}

/// The character that the text begins with, if it is one that a terminal shows; else "".
std::string_view shownCharacter(std::string_view text) {
  const unsigned char first = byteOf(text[0]);
  const std::size_t size = sizeOfCharacter(first);
  if (size == 0 || text.size() < size) return "";
  const std::string_view character = text.substr(0, size);
  if (size == 1) return (first < 0x20 && first != '\n' && first != '\t') || first == 0x7F ? "" : character;
  const auto goesOn = [](char c) { return (byteOf(c) & 0xC0) == 0x80; };
  if (!std::ranges::all_of(character.substr(1), goesOn)) return "";
  return first == 0xC2 && byteOf(character[1]) < 0xA0 ? "" : character;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const std::string_view character = shownCharacter(text);
    if (character.empty())
      shown += fmt::format("\\x{:02X}", byteOf(text[0]));
    else
      shown.append(character);
    text.remove_prefix(std::max<std::size_t>(1, character.size()));
  }
  return shown;
}

void tell(std::string_view text) noexcept try { std::fputs(printable(text).c_str(), stderr); } catch (...) {
  // Without memory for it nothing is said.
}

}  // namespace strainfinger
