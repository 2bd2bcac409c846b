#pragma once
// What fingers say by bits and numbers, in the words of the frames' tables.

#include <span>
#include <string>
#include <vector>

#include "common/frame_layout.hpp"

namespace strainfinger::live {

/// "stale zero" of "stale_zero"; a value without a name by its number.
std::string wordFor(std::span<const ValueName> names, int value);

/// A word for each bit that is set, lowest first.
std::vector<std::string> wordsFor(std::span<const ValueName> names, std::uint32_t bits);

/// Numbers of the bits that are set, lowest first.
std::vector<int> bitNumbers(std::uint32_t bits);

}  // namespace strainfinger::live
