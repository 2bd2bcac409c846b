#include "host/live/words.hpp"

#include <algorithm>

#include "host/can/frame_catalogue.hpp"

namespace strainfinger::live {

std::string wordFor(std::span<const ValueName> names, int value) {
  std::string word = can::nameText(names, value);
  std::ranges::replace(word, '_', ' ');
  return word;
}

std::vector<std::string> wordsFor(std::span<const ValueName> names, std::uint32_t bits) {
  std::vector<std::string> words;
  for (const int bit : bitNumbers(bits)) words.push_back(wordFor(names, bit));
  return words;
}

std::vector<int> bitNumbers(std::uint32_t bits) {
  std::vector<int> numbers;
  for (int bit = 0; bit < 32; ++bit)
    if ((bits >> bit & 1U) != 0) numbers.push_back(bit);
  return numbers;
}

}  // namespace strainfinger::live
