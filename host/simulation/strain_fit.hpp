#pragma once
// What a touch means for the gauges: to be drawn beside what they read.

#include <vector>

#include "host/can/touch_receiver.hpp"
#include "host/simulation/gauge_strains.hpp"

namespace strainfinger::simulation {

/// Of the finger that the config tells of, the drawing and its calibration, whatever was built. A second
/// contact counts as a line, because no width is told of it.
class StrainFit {
 public:
  explicit StrainFit(const config::FingerConfig& config);

  /// What each gauge should read under the touch, gains included; of a contact whose place or normal force
  /// is not known there is nothing.
  std::vector<double> readings(const can::TouchReport& touch) const;

  /// The strain at any angle of the ring, as deep as drawn.
  double at(double angle_rad, const can::TouchReport& touch) const;

 private:
  std::vector<Touch> touchesOf(const can::TouchReport& report) const;
  Touch touchOf(const can::ContactReport& contact, double width_m) const;

  double length_m_;
  GaugeStrains strains_;
};

}  // namespace strainfinger::simulation
