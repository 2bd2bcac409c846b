#pragma once
// The picture of what one finger said over time.

#include <string>
#include <vector>

#include "host/base/no_value.hpp"
#include "host/plot/picture.hpp"

namespace strainfinger::plot {

/// One touch sample; kNoValue where the finger said nothing.
struct LogPoint {
  double time_s = 0;  ///< since the log's first frame
  double angle_deg = kNoValue;
  double sigmaAngle_deg = kNoValue;
  double normal_n = kNoValue;
  double sigmaNormal_n = kNoValue;
  double tangential_n = kNoValue;
  double sigmaTangential_n = kNoValue;
  double width_m = kNoValue;
  double sigmaWidth_m = kNoValue;
  double secondAngle_deg = kNoValue;
  unsigned flags = 0;  ///< bit i: flagNames[i] holds
};

struct LogRecord {
  std::string heading;
  std::vector<LogPoint> points;        ///< in order of time
  std::vector<std::string> flagNames;  ///< of bit 0, 1, ..
};

/// Angle, forces and width with bands of one sigma, and the flags, over time. A gap of more than `kGap_s` and
/// the end of a touch are gaps in the bands.
Picture logPicture(const LogRecord& record);

/// In contact a finger speaks every 50 ms at least.
inline constexpr double kGap_s = 0.2;

}  // namespace strainfinger::plot
