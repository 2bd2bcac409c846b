#pragma once
// How far a mistyped word is from another.

#include <cstddef>
#include <string_view>

namespace strainfinger {

/// Levenshtein's distance: insertions, deletions and replacements of one character.
std::size_t editDistance(std::string_view a, std::string_view b);

}  // namespace strainfinger
