#pragma once
// The picture of a touched finger: what the gauges saw at one moment, and where the contact went.

#include <array>
#include <vector>

#include "host/base/no_value.hpp"
#include "host/plot/picture.hpp"

namespace strainfinger::plot {

/// A contact as known or as estimated; kNoValue throughout where there is none.
struct ContactPoint {
  double angle_deg = kNoValue;
  double normal_n_per_m = kNoValue;
  double tangential_n_per_m = kNoValue;
};

struct ProfilePoint {
  double angle_deg;
  double true_strain;
  double fitted_strain;
};

struct GaugeReading {
  double angle_deg;
  double strain;
  double fitted_strain;
  double sigma_strain;
};

/// A touch and the contact that was told of it; either may be missing.
struct TrackedContact {
  ContactPoint truth;
  ContactPoint estimate;
  double sigmaAngle_deg = kNoValue;
  bool isFlagged = false;  ///< the estimate says itself that it may be wrong
};

struct TrackPoint {
  double time_s;
  std::vector<TrackedContact> contacts;  ///< none: nothing touches, and nothing is told
};

struct TouchRecord {
  double moment_s = 0;                   ///< when the readings were taken
  std::vector<TrackedContact> contacts;  ///< then
  std::vector<ProfilePoint> profile;     ///< in order of angle, once around
  std::vector<GaugeReading> readings;
  std::vector<TrackPoint> track;  ///< in order of time
  double outerRadius_m = 0;       ///< turns an error of angle into an arc of the surface
};

/// Left: the strain around the ring at `moment_s`: true, read, fitted, and the residuals of the fit. Right:
/// angle, its error and the loads of each contact over time, true and estimated. Angles may be in any
/// revolution.
Picture touchPicture(const TouchRecord& record);

/// The names of its data files.
inline constexpr std::array kTouchData{"profile", "readings", "track"};

}  // namespace strainfinger::plot
