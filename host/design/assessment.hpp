#pragma once
// What a finger could tell of a touch, and whether the firmware can work with it: to choose one to build.

#include <cstddef>
#include <optional>
#include <string>

#include "host/config/finger_config.hpp"
#include "host/simulation/scenario.hpp"

namespace strainfinger::design {

/// A bound over all places of a touch; infinite where the readings don't determine it.
struct Bound {
  double median = 0, worst = 0;
};

/// Least standard deviations that an unbiased fit can have (Cramer and Rao), from noise alone.
struct Bounds {
  Bound arc_m;  ///< of the place, along the surface
  Bound normal_n_per_m;
  Bound tangential_n_per_m;
  std::optional<Bound> width_m;  ///< of a touch that has a width, where that is fitted
  /// Of the places, at how many the readings determine the touch: the place within half a pitch, the normal
  /// load within itself; 0 to 1. Beyond that a bound is no figure to go by.
  double identifiableShare = 0;
  double largest_strain = 0;  ///< that a gauge reads at any of the places
};

/// The firmware's own locator, tried on the finger.
struct Trial {
  std::size_t tableBytes = 0;
  /// Of the places, at how many it tells the touch without a flag, from readings without noise; 0 to 1.
  double certainShare = 0;
  double detected_n_per_m = 0;
  double fullScale_n_per_m = 0;
};

struct Assessment {
  std::optional<Bounds> bounds;  ///< none: the elastic model has no answer
  std::optional<Trial> trial;    ///< none: no tables can be made
  std::string problem;           ///< why this is no finger for such a touch; empty: it is one
};

/// Of the finger as it is drawn: its calibration and how it is built count for nothing, its ring is even.
/// `touch`: its place doesn't count. Whether the width is known, the config says. What is wrong with the
/// config's values together is a problem, not a failure. Cost: 0.03 s for the default finger, as 1/depth for
/// shallow gauges, most of it the firmware's searches.
Assessment assess(const config::FingerConfig& config, const simulation::Touch& touch);

}  // namespace strainfinger::design
