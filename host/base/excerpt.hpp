#pragma once
// What a user wrote, as messages quote it: no longer than says what is meant.

#include <string>
#include <string_view>
#include <vector>

namespace strainfinger {

/// The text, or of a long one its beginning and "..". UTF-8 is not cut within a character.
std::string excerpt(std::string_view text);

/// The first five names as excerpt() has them, and how many more there are.
std::string excerptNames(const std::vector<std::string>& names);

/// A message that others made of what a user wrote, each of its words as excerpt() has it.
std::string excerptWords(std::string_view message);

}  // namespace strainfinger
