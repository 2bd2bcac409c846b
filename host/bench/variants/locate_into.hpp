#pragma once
// The firmware's locator with other rules of when to stop and which rows to use: compiled anew for each rule
// of variants.cmake, whose firmware/core/step_rule.hpp stands before the firmware's, in a namespace of its
// own (the project's is renamed on the compiler's command line).

#include <cstdint>

namespace strainfinger::bench {

/// Locates as fitOf() of catalogue.hpp does, and makes the Fit at `fit`. Types that have this variant's
/// namespace are passed as addresses; they are laid out alike.
void locateInto(void* fit, const void* tables, bool byThree, const std::int32_t* strains_q32);

}  // namespace strainfinger::bench
