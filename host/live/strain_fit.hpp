#pragma once
// What a touch means for the gauges: to be drawn beside what they read.

#include <vector>

#include "host/can/touch_receiver.hpp"
#include "host/simulation/gauge_strains.hpp"

namespace strainfinger::live {

class StrainFit {
 public:
  explicit StrainFit(const config::FingerConfig& config);

  /// What each gauge should read under the touch, gains included; of a contact whose place or normal force
  /// is not known there is nothing.
  std::vector<double> readings(const can::TouchReport& touch) const;

 private:
  simulation::Touch touchOf(const can::ContactReport& contact, double width_m) const;

  double length_m_;
  simulation::GaugeStrains strains_;
};

}  // namespace strainfinger::live
