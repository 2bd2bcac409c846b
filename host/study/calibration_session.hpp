#pragma once
// Fingers as they are built, touched for a session: what `calibrate` gets, and the truth beside it.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "host/calibration/calibrate.hpp"
#include "host/config/finger_config.hpp"
#include "host/evidence/touches.hpp"

namespace strainfinger::study {

/// What a session consists of.
struct SessionPlan {
  int touches = 300;
  int knownLoads = 5;       ///< the first so many touches are on a scale
  int knownDirections = 1;  ///< so many firm touches after them are in a known direction: a mark is pressed
  double junk = 0;          ///< share of touches that no single touch at rest explains
  evidence::TouchRanges ranges{.load_n_per_m = {2, 40}, .width_m = {0.5e-3, 4e-3}};
};

/// What is known of the touches, for calibrate(): exactly.
inline constexpr calibration::KnownErrors kExactlyKnown{0, 0};

struct Session {
  config::FingerConfig finger;  ///< the drawing; [as_built] is the truth
  Eigen::MatrixXd readings;     ///< a row a touch
  std::vector<calibration::KnownTouch> known;
  std::vector<bool> isJunk;
};

/// Gauges off by 0.5 deg, 0.05 mm and 3 % (standard deviations), a core up to 0.1 mm thicker or thinner, a
/// Poisson ratio from 0.47 to 0.5, drawn by the seed.
config::FingerConfig randomFinger(std::uint64_t seed);

/// Touches of that finger, drawn by the seed. Junk is of three kinds in turn: two contacts; a slip, half of
/// the reading being of another place; a gauge that hits its rail.
Session sessionOf(const config::FingerConfig& finger, const SessionPlan& plan, std::uint64_t seed);

}  // namespace strainfinger::study
