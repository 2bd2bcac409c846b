#include "host/base/excerpt.hpp"

#include <algorithm>
#include <cstddef>

namespace strainfinger {
namespace {

constexpr std::size_t kMost = 60;
constexpr std::string_view kWordEnds = " \n";

bool isWithinCharacter(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

}  // namespace

std::string excerpt(std::string_view text) {
  if (text.size() <= kMost) return std::string(text);
  std::size_t end = kMost;
  while (end > 0 && isWithinCharacter(text[end])) --end;
  return std::string(text.substr(0, end)).append("..");
}

std::string excerptNames(const std::vector<std::string>& names) {
  constexpr std::size_t kMostNames = 5;
  std::string result;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i)
    result.append(i > 0 ? ", " : "").append(excerpt(names[i]));
  if (names.size() > kMostNames)
    result.append(" and ").append(std::to_string(names.size() - kMostNames)).append(" more");
  return result;
}

std::string excerptWords(std::string_view message) {
  std::string result;
  while (!message.empty()) {
    const std::size_t word = std::min(message.find_first_of(kWordEnds), message.size());
    result.append(excerpt(message.substr(0, word))).append(message.substr(word, 1));
    message.remove_prefix(std::min(word + 1, message.size()));
  }
  return result;
}

}  // namespace strainfinger
