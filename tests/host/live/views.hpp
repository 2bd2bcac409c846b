#pragma once
// Views to draw.

#include "host/live/finger_view.hpp"

namespace strainfinger::live {

/// Node 1, touched at the right, 0.282 N normal and -0.1 N tangential.
inline FingerView touchedFinger() {
  can::TouchReport touch{{.angle_deg = 0,
                          .sigmaAngle_deg = 0.5,
                          .normal_n = 0.282,
                          .sigmaNormal_n = 0.004,
                          .tangential_n = -0.1,
                          .sigmaTangential_n = 0.003,
                          .quality_percent = 97}};
  touch.width_m = 0.00204;
  touch.sigmaWidth_m = 0.00015;
  touch.flags = {FingerFlag::kContact, FingerFlag::kStaleZero, FingerFlag::kSimulated};
  return {.bus = "can0",
          .node = 1,
          .heartbeat = {.state = FingerState::kRun, .uptime_s = 3723, .temperature_degC = 25},
          .gauges = GaugesFrame{.out_of_use = 0, .zero_age_s = 61},
          .touch = touch,
          .strongest_n = 0.4,
          .contactsPerSecond = 500,
          .jitter_s = 0.0002,
          .received = 3000,
          .lost = 2};
}

inline BusView busWith(std::vector<FingerView> fingers) {
  return {.name = "can0",
          .time_us = 12'300'000,
          .framesPerSecond = 1512,
          .load = 0.168,
          .fingers = std::move(fingers)};
}

}  // namespace strainfinger::live
