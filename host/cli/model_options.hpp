#pragma once
// What the subcommands that ask the elastic model have in common.

#include "host/config/finger_config.hpp"

namespace strainfinger::cli {

/// Throws Failure(kUsage) unless core_radius_m <= radius_m <= outer_radius_m; the message names --radius-m.
void requireInRubber(double radius_m, const config::Finger& finger);

}  // namespace strainfinger::cli
