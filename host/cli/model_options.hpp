#pragma once
// What the subcommands that ask the elastic model have in common.

#include <CLI/CLI.hpp>

#include "host/config/finger_config.hpp"

namespace strainfinger::cli {

/// An option with a real value from `least` to `most`; not a number is refused too. On a list it checks each
/// of its elements.
CLI::Validator realFrom(double least, double most);

/// Throws Failure(kUsage) unless core_radius_m <= radius_m <= outer_radius_m; the message names --radius-m.
void requireInRubber(double radius_m, const config::Finger& finger);

}  // namespace strainfinger::cli
