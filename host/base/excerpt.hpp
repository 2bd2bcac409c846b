#pragma once
// What a user wrote, as messages quote it: no longer than says what is meant.

#include <string>
#include <string_view>

namespace strainfinger {

/// The text, or of a long one its beginning and "..". UTF-8 is not cut within a character.
std::string excerpt(std::string_view text);

/// A message that others made of what a user wrote, each of its words as excerpt() has it.
std::string excerptWords(std::string_view message);

}  // namespace strainfinger
