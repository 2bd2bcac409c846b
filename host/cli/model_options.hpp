#pragma once
// What the subcommands that ask the elastic model have in common.

#include <vector>

#include "host/config/finger_config.hpp"

namespace strainfinger::cli {

/// Strains above it are told to be none that a linear model is for.
inline constexpr double kMostLinearStrain = 0.5;

/// Throws Failure(kUsage) unless core_radius_m <= radius_m <= outer_radius_m; the message names --radius-m.
void requireInRubber(double radius_m, const config::Finger& finger);

/// `count` numbers, two or more, evenly from `from` to `to`, both included exactly.
std::vector<double> evenly(double from, double to, int count);

}  // namespace strainfinger::cli
