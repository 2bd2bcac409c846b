#pragma once
// The picture of what one finger said over time.

#include <array>
#include <string>
#include <vector>

#include "common/frames.hpp"
#include "host/can/touch_receiver.hpp"
#include "host/plot/picture.hpp"

namespace strainfinger::plot {

struct LogPoint {
  double time_s = 0;  ///< since the log's first frame
  can::TouchReport touch;
};

struct LogRecord {
  std::string heading;
  std::vector<LogPoint> points;  ///< in order of time
};

/// Angle, forces and width with bands of one sigma, and the flags, over time. Edges of bands of forces and
/// width that stand for that or more are marked. A gap of more than `kGap_s` and
/// the end of a touch are gaps in the bands.
Picture logPicture(const LogRecord& record);

/// The names that its data files can have.
inline constexpr std::array kLogData{"angle", "force", "width", "flags", "or-more", "second"};

/// Four times as long as a finger in contact says nothing at most.
inline constexpr double kGap_s = 4e-3 * kContactPeriod_ms;

}  // namespace strainfinger::plot
